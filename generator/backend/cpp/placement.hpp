/// Where the values of a device are stored, and how many bytes they have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// In a struct in RAM or in flash, or in the word of a table.
enum class MemoryPlace : std::uint8_t { ram, rom, immediate, immediate_plus_node_id };

/// The places of the values of one device.
class Placement {
 public:
  Placement(const Device& device, const Options& options);

  [[nodiscard]] MemoryPlace place(const Object& object, const Entry& entry) const;

  /// Whether the entry cannot change at run time.
  [[nodiscard]] bool is_constant(const Object& object, const Entry& entry) const;

  /// A mapping parameter of a static PDO: a constant regardless of its access type in the EDS.
  [[nodiscard]] bool is_static_mapping(std::uint16_t index) const;

  /// Whether the entry has a row in the table of limits: a value that can be written over the bus, and the capacity
  /// of each string that can change. A mapping entry has none: it is checked against the dictionary. Limits equal to
  /// the range of the data type have none.
  [[nodiscard]] bool has_limits(const Object& object, const Entry& entry) const;

  /// Whether a received value is checked: against limits, the modes of operation of a drive, or the values of a
  /// closed enumeration.
  [[nodiscard]] bool is_limited(const Object& object, const Entry& entry) const;

  /// Elements of the same numeric type and access in the same memory, without gaps: they share one word.
  [[nodiscard]] bool is_uniform_array(const Object& object) const;

 private:
  [[nodiscard]] bool needs_address(const Entry& entry) const;

  const Device& device_;
  const Options& options_;
  std::vector<EntryKey> settable_;               ///< ascending
  std::vector<std::uint16_t> dynamic_mappings_;  ///< indices, ascending
  /// By sub-index: the value in all static mapping parameters that have it; empty if they differ.
  std::map<std::uint8_t, std::optional<std::uint64_t>> static_mapping_values_;
  bool has_dynamic_tpdo_ = false;
};

/// The minimum and maximum of a numeric type, as the bits of its values.
[[nodiscard]] std::uint64_t lowest(const canopen::DataTypeRow& type);
[[nodiscard]] std::uint64_t highest(const canopen::DataTypeRow& type);

/// Whether the entry is zero after a reset.
[[nodiscard]] bool is_zero(const Entry& entry);

/// Maximum bytes of the string in an entry.
[[nodiscard]] std::uint32_t string_capacity(const Entry& entry, const Options& options);

/// Bytes of a string type: its capacity, and a terminator if the options require one.
[[nodiscard]] std::uint32_t string_bytes(const Entry& entry, const Options& options);

/// Bytes from one element of an array to the next.
[[nodiscard]] unsigned stride(const Entry& entry);

/// Alignment of the C++ type of an entry, at most.
[[nodiscard]] unsigned alignment_of(const Entry& entry);

/// Bytes of the C++ type of an entry.
[[nodiscard]] std::size_t size_of(const Entry& entry, const Options& options);

[[nodiscard]] constexpr std::size_t round_up(std::size_t size, std::size_t alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

}  // namespace edsc
