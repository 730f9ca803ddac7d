/// A value read from a device as a ParameterValue.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "device/device.hpp"

namespace edsc {

/// The value of an SDO upload in EDS spelling: numbers in the base of the default value, REAL as the shortest decimal
/// number, OCTET_STRING in hexadecimal digits, VISIBLE_STRING without a trailing 00h. Nothing for a value with the
/// wrong length, and for values that an EDS cannot express: an empty string, a text of several lines.
[[nodiscard]] std::optional<std::string> parameter_text(const Entry& entry, std::span<const std::uint8_t> bytes);

}  // namespace edsc
