/// Multiplex PDOs (CiA 301, 7.2.2.5): a PDO with one object of up to 32 bits, which its data identify.
///
///   byte 0        bit 7: 1 destination, 0 source addressing mode (DAM, SAM); bits 6..0: node-ID, in DAM 0 for all
///   bytes 1 to 3  index and sub-index: in DAM of the receiver's object, in SAM of the sender's
///   bytes 4 to 7  the value, low byte first, padded with zeros
///
/// A PDO is multiplexed if sub-index 0 of its mapping parameter is 254 (SAM) or 255 (DAM). Its transmission type is 254
/// or 255; an event timer has no effect. Only devices with the option `mpdo` have this code in their image.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/can/node_id.hpp"
#include "canopen/od/access.hpp"
#include "canopen/od/object.hpp"

namespace canopen {

/// Destination of a DAM-MPDO: an object of one node, or of all nodes (node-ID 0).
struct MpdoDestination {
  NodeId node_id;
  std::uint16_t index;
  std::uint8_t sub_index;
};

/// The value of a DAM-MPDO, for the compiler's messages. A signed value is sent as the bits of an unsigned one.
struct MpdoData : Object<0x0000, 0, std::uint32_t, Access::rw> {};

/// The data bytes of an MPDO.
class Mpdo {
 public:
  using Data = std::array<std::uint8_t, 8>;

  /// `value`: one to four bytes.
  [[nodiscard]] static Data source(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                                   std::span<const std::uint8_t> value) {
    Data data{node_id.value(), static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), sub_index};
    std::memcpy(&data[4], value.data(), value.size());
    return data;
  }

  [[nodiscard]] static Data destination(const MpdoDestination& to, std::uint32_t value) {
    std::array<std::uint8_t, 4> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    Data data = source(to.node_id, to.index, to.sub_index, bytes);
    data[0] |= destination_bit;
    return data;
  }

  explicit Mpdo(const Data& data) : data_{data} {}

  [[nodiscard]] bool addresses_destination() const { return (data_[0] & destination_bit) != 0; }
  [[nodiscard]] std::uint8_t node_id() const { return data_[0] & 0x7F; }
  [[nodiscard]] std::uint16_t index() const { return static_cast<std::uint16_t>(data_[1] | data_[2] << 8); }
  [[nodiscard]] std::uint8_t sub_index() const { return data_[3]; }
  [[nodiscard]] const std::uint8_t* value() const { return &data_[4]; }

 private:
  static constexpr std::uint8_t destination_bit = 0x80;

  const Data& data_;
};

}  // namespace canopen
