/// Values and texts of the data sheet as C++ source.
#pragma once

#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// A literal of the value's type. COB-IDs and other numbers that the data sheet spells in hexadecimal stay so.
[[nodiscard]] std::string cpp_literal(const Value& value, const canopen::DataTypeRow& type);

/// The initializer of a member of `cpp_member_type`: a literal, or a list in braces.
[[nodiscard]] std::string cpp_initializer(const Value& value, const canopen::DataTypeRow& type);

/// `"text"` with all that is not plain ASCII escaped.
[[nodiscard]] std::string cpp_string(std::string_view text);

/// Text that may stand behind `//`: one line, no backslash; printable.
[[nodiscard]] std::string cpp_comment(std::string_view text);

/// The bytes of a string value as the wire carries them: UNICODE_STRINGs are UTF-16, low byte first.
[[nodiscard]] std::size_t wire_length(const Value& value, const canopen::DataTypeRow& type);

}  // namespace edsc
