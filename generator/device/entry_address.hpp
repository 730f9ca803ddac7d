/// Entries of a dictionary by index and sub-index.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace edsc {

/// An entry: index and sub-index.
using EntryKey = std::pair<std::uint16_t, std::uint8_t>;

/// An entry, or without a sub-index an object.
struct EntryAddress {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub_index;

  friend bool operator==(const EntryAddress&, const EntryAddress&) = default;
};

}  // namespace edsc
