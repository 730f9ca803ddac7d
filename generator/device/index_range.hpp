/// Ranges of indices, the rows of tables that treat objects alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace edsc {

struct IndexRange {
  std::uint16_t first, last;
};

template <std::size_t N>
[[nodiscard]] constexpr bool contains(const std::array<IndexRange, N>& ranges, std::uint16_t index) {
  return std::ranges::any_of(ranges, [&](const IndexRange& r) { return index >= r.first && index <= r.last; });
}

/// Mapping parameters of RPDOs and TPDOs (CiA 301, 7.5.2.36 and 7.5.2.38).
inline constexpr std::array mapping_parameters = {IndexRange{0x1600, 0x17FF}, IndexRange{0x1A00, 0x1BFF}};

}  // namespace edsc
