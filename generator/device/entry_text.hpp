/// Values of an entry as text for people, with its unit and limits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "values/parse_value.hpp"
#include "values/value_text.hpp"

namespace edsc {

/// By the meaning of the entry: a quantity as the physical value, `21.5 °C`; a named value as `3 profile_velocity`; a
/// word with fields as `0237h operation_enabled, remote`. UNSIGNED32 values of communication parameters, such as
/// COB-IDs and mappings, in hexadecimal only. `other` is the value of the object on which fields depend; nothing if it
/// is unknown.
void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes,
                  std::optional<std::int64_t> other = std::nullopt);
/// The same as a separate string.
[[nodiscard]] std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes,
                                     std::optional<std::int64_t> other = std::nullopt);

/// The meaning of an integer; null for other entries, and without one.
[[nodiscard]] const Meaning* meaning_of_integer(const Entry& entry);

/// The quantity of a number with a unit, scale or offset; null for other entries.
[[nodiscard]] const Quantity* quantity_of(const Entry& entry);
/// The same, but null for a quantity without a unit.
[[nodiscard]] const Quantity* quantity_with_unit(const Entry& entry);

/// `0..3000 rpm`: the limits in the EDS; empty if it has none.
[[nodiscard]] std::string limits_text(const Entry& entry);

/// Reads what `value_text` writes. A number with a unit is a physical value, also in another unit of the dimension; a
/// number without a unit is the raw number; a name is a named value, and names separated by commas are the masked
/// values and fields of a word (`parse_parts`). Checks the limits of the entry, and that closed enumerations, of the
/// entry or of its fields, have the number.
[[nodiscard]] ParsedValue parse_value_text(const Entry& entry, std::string_view text);
/// The same without these checks, to send a value that the device should reject.
[[nodiscard]] ParsedValue parse_unchecked(const Entry& entry, std::string_view text);

}  // namespace edsc
