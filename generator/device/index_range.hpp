/// Ranges of indices for tables of objects.
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

/// Objects that are commands, not parameters: clear the error history (1003h), store and restore parameters (1010h,
/// 1011h), OS command and prompt (1023h..1026h) of CiA 301; of CiA 302 configuration request (1F25h), program download
/// and program control (1F50h, 1F51h), request NMT and request node guarding (1F82h, 1F83h).
inline constexpr std::array command_objects = {IndexRange{0x1003, 0x1003}, IndexRange{0x1010, 0x1011},
                                               IndexRange{0x1023, 0x1026}, IndexRange{0x1F25, 0x1F25},
                                               IndexRange{0x1F50, 0x1F51}, IndexRange{0x1F82, 0x1F83}};

}  // namespace edsc
