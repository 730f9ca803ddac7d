/// The canonical spelling of numbers, with the same base and value.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

struct Spelling {
  std::string text;
  std::string_view remark;  ///< an inline comment after the value, with its `;` or `#`; may be empty
};

/// A number of an EDS key such as DataType or VendorNumber: `0x` and at least `hex_digits` upper-case digits; or
/// decimal, or octal. Text that is not a number is unchanged.
[[nodiscard]] Spelling spell_number(std::string_view text, unsigned hex_digits);

/// A value of an entry of this type: default value, limit or parameter value. With the number of hexadecimal digits of
/// the type, and formulas as `$NODEID+0x180`; strings and invalid values are unchanged.
[[nodiscard]] Spelling spell_value(std::string_view text, const canopen::DataTypeRow& type);

/// An AccessType in lower case; other text is unchanged.
[[nodiscard]] Spelling spell_access(std::string_view text);

/// The number of hexadecimal digits of a type.
[[nodiscard]] unsigned hex_digits_of(const canopen::DataTypeRow& type);

}  // namespace edsc
