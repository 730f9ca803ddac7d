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

/// With the unit of the entry if raw values are in it (no Factor other than 1). UNSIGNED32 values of communication
/// parameters, such as COB-IDs and mappings, in hexadecimal only.
void append_value(std::string& text, const Entry& entry, std::span<const std::uint8_t> bytes);
/// The same as a separate string.
[[nodiscard]] std::string value_text(const Entry& entry, std::span<const std::uint8_t> bytes);

/// `0..3000 rpm`: the limits in the EDS; empty if it has none.
[[nodiscard]] std::string limits_text(const Entry& entry);

/// Checks the limits of the entry; its unit may follow the number, unless the entry has a Factor other than 1.
[[nodiscard]] ParsedValue parse_value_text(const Entry& entry, std::string_view text);

}  // namespace edsc
