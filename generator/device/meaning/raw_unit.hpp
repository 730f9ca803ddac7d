/// What raw numbers of a quantity are: for rules and texts about values that are not converted.
#pragma once

#include <string>

#include "device/meaning/meaning.hpp"

namespace edsc {

/// What a raw value of 1 is: `rpm`, `0.1 V`, `0.5 °C, 0 is -40 °C`. Without a unit the scale alone; empty for a plain
/// number.
[[nodiscard]] std::string raw_unit_text(const Quantity& quantity);

/// Whether each raw number is the same physical value, also if it is stated in another unit of the dimension: 0.001 s
/// and ms.
[[nodiscard]] bool has_same_raw_numbers(const Quantity& a, const Quantity& b);

}  // namespace edsc
