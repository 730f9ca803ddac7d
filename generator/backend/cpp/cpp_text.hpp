/// Values and texts of the EDS as C++ source.
#pragma once

#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// A literal of the value's type. COB-IDs and other numbers that are hexadecimal in the EDS remain hexadecimal.
[[nodiscard]] std::string cpp_literal(const Value& value, const canopen::DataTypeRow& type);

/// The initializer of a member of `cpp_member_type`: a literal, or a list in braces.
[[nodiscard]] std::string cpp_initializer(const Value& value, const canopen::DataTypeRow& type);

/// `"text"` with everything except printable ASCII escaped.
[[nodiscard]] std::string cpp_string(std::string_view text);

/// Text for a `//` comment: one line, no backslash; printable.
[[nodiscard]] std::string cpp_comment(std::string_view text);

/// The bytes of a string value as transmitted: UNICODE_STRINGs in UTF-16, low byte first.
[[nodiscard]] std::size_t wire_length(const Value& value, const canopen::DataTypeRow& type);

}  // namespace edsc
