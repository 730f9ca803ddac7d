/// Values and texts of the EDS as C++ source.
#pragma once

#include <string>
#include <string_view>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A literal of the value's type. COB-IDs and other numbers that are hexadecimal in the EDS remain hexadecimal.
[[nodiscard]] std::string cpp_literal(const Value& value, const canopen::DataTypeRow& type);

/// The initializer of a member for the value of an entry: a literal, or a list in braces.
[[nodiscard]] std::string cpp_initializer(const Entry& entry);

/// The C++ type of an entry; a string with its capacity.
[[nodiscard]] std::string cpp_type(const Entry& entry, const Options& options);

/// The constant of canopen::entry for the values of a data type.
[[nodiscard]] std::string type_word(const canopen::DataTypeRow& type);

/// `"text"` with everything except printable ASCII escaped.
[[nodiscard]] std::string cpp_string(std::string_view text);

/// Text for a `//` comment: one line, no backslash; printable.
[[nodiscard]] std::string cpp_comment(std::string_view text);

}  // namespace edsc
