/// The mapping of a PDO: its objects and their places in the frame (CiA 301, 7.5.2.36 and 7.5.2.38).
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pdo/limits.hpp"

namespace edsc {

enum class PdoDirection : std::uint8_t { receive, transmit };

/// The indices of the parameters of a PDO.
struct PdoParameterIndices {
  std::uint16_t communication, mapping;
};
/// `number`: from 1. RPDO 1 has 1400h and 1600h, TPDO 1 has 1800h and 1A00h.
[[nodiscard]] PdoParameterIndices parameters_of(PdoDirection direction, std::uint16_t number);
/// Returns 1600h for 1400h, and 1A00h for 1800h.
[[nodiscard]] std::uint16_t mapping_parameter_of(std::uint16_t communication);

/// Whether a number of mapped objects, sub-index 0, makes the PDO a multiplex PDO (CiA 301, 7.2.2.5).
[[nodiscard]] bool is_multiplexed(std::uint64_t count);

/// What one entry of a mapping parameter maps. 0 is an empty entry.
struct MappingValue {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t bits = 0;

  /// From the value of the entry: index, sub-index and length in bits, from the high byte to the low byte.
  [[nodiscard]] static MappingValue of(std::uint32_t value);
  [[nodiscard]] std::uint32_t value() const;

  [[nodiscard]] bool is_empty() const { return value() == 0; }
  /// Whether the index is one of a data type: bits of an RPDO that no object gets.
  [[nodiscard]] bool is_dummy() const;
  /// The type of a dummy; null for an object or an unknown type.
  [[nodiscard]] const canopen::DataTypeRow* dummy_type() const;
  /// Whether a device with this Granularity, which is not 0, can map the length (CiA 306-1, 4.5).
  [[nodiscard]] bool is_multiple_of(std::uint64_t granularity) const { return bits % granularity == 0; }

  friend bool operator==(const MappingValue&, const MappingValue&) = default;
};

/// A mapped object with its place in the frame. The first object has the lowest bits.
struct PlacedObject : MappingValue {
  std::uint8_t position = 0;  ///< 1..: its sub-index in the mapping parameter
  std::uint16_t offset = 0;   ///< in bits

  [[nodiscard]] unsigned end() const { return unsigned{offset} + bits; }
  [[nodiscard]] bool is_within(const PdoLimits& limits) const { return end() <= limits.bits(); }
  [[nodiscard]] bool has_bits_of(const PlacedObject& other) const {
    return offset == other.offset && bits == other.bits;
  }
};

/// Returns the length of a mapping in bits.
template <class Objects>
[[nodiscard]] unsigned total_bits(const Objects& objects) {
  unsigned bits = 0;
  for (const MappingValue& mapped : objects) bits += mapped.bits;
  return bits;
}

/// Returns objects that follow each other in a frame, with positions from 1.
[[nodiscard]] std::vector<PlacedObject> placed(std::span<const MappingValue> objects);

/// Reads a mapping parameter: the entries 1..`count` that are not empty. `value_of`: the value of a sub-index, 0 if it
/// does not exist.
[[nodiscard]] std::vector<PlacedObject> read_mapping(std::uint8_t count,
                                                     const std::function<std::uint32_t(std::uint8_t)>& value_of);

}  // namespace edsc
