/// Which differences a declared deviation covers: those that its case compares as well.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "accept/compare_dictionary.hpp"
#include "accept/difference.hpp"
#include "conform/deviations.hpp"
#include "device/index_range.hpp"

namespace edsc::accept {

/// A case of area 4, the object dictionary, and the differences that can make it fail.
struct DeclaringCase {
  std::string_view id;
  IndexRange objects;
  std::string_view objects_text;  ///< in the documents
  std::span<const Kind> kinds;
  bool only_sub_index_255 = false;
};

[[nodiscard]] std::span<const DeclaringCase> declaring_cases();

/// Whether a deviation with this case and object declares a difference of this kind in the entry.
[[nodiscard]] bool covers(const conform::Deviation& deviation, Kind kind, std::uint16_t index, std::uint8_t sub_index);

/// Declares the differences of the entries and of the identity that a deviation covers. Marks such deviations as used.
void apply_deviations(std::span<conform::Deviation> deviations, Comparison& comparison);

}  // namespace edsc::accept
