/// CAN-IDs and COB-IDs: the pre-defined connection set, the flag bits, and the CAN-IDs that may not be configured.
#pragma once

#include <array>  // std::size: <iterator> would bring streams with it
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "canopen/can/node_id.hpp"

namespace canopen {

/// Function codes of the pre-defined connection set (CiA 301, 7.3.5), to which the node-ID is added.
namespace function_code {
inline constexpr std::uint16_t nmt = 0x000;
inline constexpr std::uint16_t sync = 0x080;
inline constexpr std::uint16_t emcy = 0x080;
inline constexpr std::uint16_t time = 0x100;
inline constexpr std::uint16_t tpdo1 = 0x180;
inline constexpr std::uint16_t rpdo1 = 0x200;
inline constexpr std::uint16_t tpdo2 = 0x280;
inline constexpr std::uint16_t rpdo2 = 0x300;
inline constexpr std::uint16_t tpdo3 = 0x380;
inline constexpr std::uint16_t rpdo3 = 0x400;
inline constexpr std::uint16_t tpdo4 = 0x480;
inline constexpr std::uint16_t rpdo4 = 0x500;
inline constexpr std::uint16_t sdo_response = 0x580;  ///< server to client
inline constexpr std::uint16_t sdo_request = 0x600;   ///< client to server
inline constexpr std::uint16_t error_control = 0x700;
}  // namespace function_code

/// Whether the pre-defined connection set assigns an 11-bit CAN-ID to a PDO.
[[nodiscard]] constexpr bool is_pdo_can_id(std::uint32_t can_id) {
  constexpr std::uint32_t first = function_code::tpdo1 + 1;
  return can_id - first < function_code::sdo_response - first;
}

/// A COB-ID as in the communication parameters: a CAN-ID and three flags (CiA 301, 7.5.2.x).
class CobId {
 public:
  static constexpr std::uint32_t invalid_bit = 0x8000'0000;   ///< PDO, SDO, EMCY: does not exist
  static constexpr std::uint32_t no_rtr_bit = 0x4000'0000;    ///< TPDO: no remote frame; SYNC: this device produces it
  static constexpr std::uint32_t extended_bit = 0x2000'0000;  ///< 29-bit identifier
  static constexpr std::uint32_t identifier = 0x3FFF'FFFF;    ///< the CAN-ID and bit 29, which selects its length

  constexpr CobId() = default;
  constexpr explicit CobId(std::uint32_t value) : value_{value} {}

  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return (value_ & invalid_bit) == 0; }
  [[nodiscard]] constexpr bool rtr_allowed() const { return (value_ & no_rtr_bit) == 0; }
  [[nodiscard]] constexpr bool extended() const { return (value_ & extended_bit) != 0; }
  [[nodiscard]] constexpr std::uint32_t can_id() const { return value_ & (extended() ? 0x1FFF'FFFFu : 0x7FFu); }

  friend constexpr bool operator==(CobId, CobId) = default;

 private:
  std::uint32_t value_ = invalid_bit;
};

/// Returns the number in up to four bytes, low byte first. A span would be passed in memory on some processors.
[[nodiscard, gnu::noinline]] inline std::uint32_t number_at(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- != 0;) value = value << 8 | bytes[i];
  return value;
}
[[nodiscard, gnu::always_inline]] inline std::uint32_t number_in(std::span<const std::uint8_t> bytes) {
  return number_at(bytes.data(), bytes.size());
}

/// Returns the COB-ID that results from writing these four bytes if the bits outside of `writable` keep their value.
/// `bytes` is changed accordingly.
[[nodiscard]] inline CobId written_cob_id(CobId before, std::uint32_t writable, std::span<std::uint8_t> bytes) {
  std::uint32_t after = number_in(bytes);
  if (writable != 0xFFFF'FFFF) {
    after = (after & writable) | (before.value() & ~writable);
    std::memcpy(bytes.data(), &after, sizeof after);
  }
  return CobId{after};
}

/// A range of CAN-IDs that no configurable object may use (CiA 301, 7.3.5, table 41). The table is ascending.
struct RestrictedCanIds {
  std::uint16_t first;
  std::uint16_t last;
};

inline constexpr RestrictedCanIds restricted_can_ids[] = {
    {0x000, 0x000}, {0x001, 0x07F}, {0x101, 0x180}, {0x581, 0x5FF},
    {0x601, 0x67F}, {0x6E0, 0x6FF}, {0x701, 0x77F}, {0x780, 0x7FF},
};

/// Reason for each row; only for messages, so that it is not part of a device's image.
inline constexpr const char* restricted_can_id_reasons[] = {
    "NMT",      "reserved",          "reserved", "default SDO, server to client", "default SDO, client to server",
    "reserved", "NMT error control", "reserved",
};

/// Whether a configurable object may not use an 11-bit CAN-ID.
[[nodiscard]] constexpr bool is_restricted(std::uint32_t can_id) {
  for (const auto& range : restricted_can_ids) {
    if (can_id <= range.last) return can_id >= range.first;
  }
  return false;
}

/// Whether a service may send or receive with a COB-ID of the dictionary: it is valid (bit 31 is 0), and its CAN-ID is
/// not restricted by CiA 301. An unusable COB-ID counts as invalid, however it was set. For 1005h and 1012h, whose bits
/// 30 and 31 have another meaning, pass only the CAN-ID and bit 29.
[[nodiscard, gnu::noinline]] constexpr bool is_usable(std::uint32_t cob_id) {
  constexpr std::uint32_t first = 0x181;  // first CAN-ID between TIME and SDO, where most COB-IDs are
  constexpr std::uint32_t count = 0x400;
  if ((cob_id & ~CobId::no_rtr_bit) - first < count) return true;
  if ((cob_id & CobId::invalid_bit) != 0) return false;
  return (cob_id & CobId::extended_bit) != 0 || !is_restricted(cob_id & 0x7FF);
}

/// Whether a COB-ID is valid and has an 11-bit CAN-ID of `range`; {1, 0} has none.
[[nodiscard]] constexpr bool is_in(RestrictedCanIds range, std::uint32_t cob_id) {
  const std::uint32_t value = cob_id & ~CobId::no_rtr_bit;
  return value >= range.first && value <= range.last;
}

/// Whether a COB-ID may be written: a 29-bit CAN-ID if the device supports it, or an 11-bit one, which must not be
/// restricted if it is in use.
[[nodiscard, gnu::noinline]] constexpr bool may_be_written(CobId cob_id, bool in_use, bool extended_ids) {
  if (cob_id.extended()) return extended_ids;
  if ((cob_id.value() & 0x1FFF'F800) != 0) return false;
  return !in_use || is_usable(cob_id.can_id());
}

/// Whether the COB-ID of a PDO, an SDO server or EMCY may change from one value to another: its CAN-ID may change only
/// while it is not valid, must have 11 bits or, with bit 29 set, 29, and a restricted one cannot be made valid.
[[nodiscard, gnu::noinline]] constexpr bool may_change(CobId before, CobId after, bool extended_ids) {
  const bool changed = ((before.value() ^ after.value()) & CobId::identifier) != 0;
  if (before.valid() && after.valid() && changed) return false;
  return may_be_written(after, !before.valid() && after.valid(), extended_ids);
}

/// Entries that contain the COB-ID of a service.
struct CobIdEntries {
  std::uint16_t first;
  std::uint16_t last;
  std::uint8_t first_sub_index;
  std::uint8_t last_sub_index;
  bool has_valid_bit;  ///< bit 31; in 1005h and 1012h, bits 30 and 31 have another meaning
};
inline constexpr CobIdEntries cob_id_entries[] = {
    {0x1005, 0x1005, 0, 0, false}, {0x1012, 0x1012, 0, 0, false}, {0x1014, 0x1014, 0, 0, true},
    {0x1201, 0x127F, 1, 2, true},  {0x1400, 0x15FF, 1, 1, true},  {0x1800, 0x19FF, 1, 1, true},
};

/// Finds the row of an entry; empty if it does not contain a COB-ID. By value: g++ with -fsanitize=undefined does not
/// compare an address with null at compile time (GCC bug 71962).
[[nodiscard]] constexpr std::optional<CobIdEntries> find_cob_id_entries(std::uint16_t index, std::uint8_t sub_index) {
  for (const CobIdEntries& row : cob_id_entries) {
    const bool fits =
        index >= row.first && index <= row.last && sub_index >= row.first_sub_index && sub_index <= row.last_sub_index;
    if (fits) return row;
  }
  return std::nullopt;
}

/// Returns why a configurable object may not use an 11-bit CAN-ID; null if it may.
[[nodiscard]] constexpr const char* restriction_of(std::uint32_t can_id) {
  for (std::size_t i = 0; i < std::size(restricted_can_ids); ++i) {
    if (can_id >= restricted_can_ids[i].first && can_id <= restricted_can_ids[i].last)
      return restricted_can_id_reasons[i];
  }
  return nullptr;
}

}  // namespace canopen
