/// Names of entries, for tools that display them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "canopen/od/data_type.hpp"
#include "canopen/od/dictionary.hpp"

namespace canopen {

struct EntryDescription {
  std::uint16_t index;
  std::uint8_t sub_index;
  DataType type;
  std::string_view object;  ///< name of the object
  std::string_view entry;   ///< name of the sub-index in an ARRAY or RECORD; empty for a VAR

  /// Returns the entry's name, or the object's if the entry does not have one.
  [[nodiscard]] constexpr std::string_view name() const { return entry.empty() ? object : entry; }
};

/// Finds an entry in a table sorted by index and sub-index; null if it does not exist.
[[nodiscard]] constexpr const EntryDescription* find_description(std::span<const EntryDescription> rows,
                                                                 std::uint16_t index, std::uint8_t sub_index) {
  const std::uint32_t key = object_key(index, sub_index);
  std::size_t low = 0;
  std::size_t high = rows.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (object_key(rows[middle].index, rows[middle].sub_index) < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  const bool found = low < rows.size() && rows[low].index == index && rows[low].sub_index == sub_index;
  return found ? &rows[low] : nullptr;
}

}  // namespace canopen
