/// Values of an entry as text for people, with its unit and limits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "values/parse_value.hpp"
#include "values/value_text.hpp"

namespace edsc {

/// A number with a unit is the physical value: raw * scale + offset. UNSIGNED32 values of communication
/// parameters, such as COB-IDs and mappings, in hexadecimal only.
void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes);
/// The same as a separate string.
[[nodiscard]] std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes);

/// The quantity of a number with a unit, scale or offset; null for other entries.
[[nodiscard]] const Quantity* quantity_of(const Entry& entry);

/// `0..3000 rpm`: the limits in the EDS; empty if it has none.
[[nodiscard]] std::string limits_text(const Entry& entry);

/// Checks the limits of the entry. A number with a unit is a physical value, also in another unit of the dimension; a
/// number without a unit is the raw number.
[[nodiscard]] ParsedValue parse_value_text(const Entry& entry, std::string_view text);

}  // namespace edsc
