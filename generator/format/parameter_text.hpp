/// The value of a device as a ParameterValue.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "device/device.hpp"

namespace edsc {

/// What an SDO upload has brought, as an EDS spells it: numbers in the base of the default value, REAL as the shortest
/// decimal number, OCTET_STRING in hexadecimal digits. The 00h after a VISIBLE_STRING is left out. Nothing for a value
/// that is not as long as its type, and for what has no spelling: an empty string, a text of several lines.
[[nodiscard]] std::optional<std::string> parameter_text(const Entry& entry, std::span<const std::uint8_t> bytes);

}  // namespace edsc
