/// The canonical spelling of numbers, with the same base and value.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

struct ValueSpelling {
  std::string text;
  std::string_view remark;  ///< an inline comment after the value, with its `;` or `#`; may be empty
};

/// A number of an EDS key such as DataType or VendorNumber: `0x` and at least `hex_digits` upper-case digits; or
/// decimal, or octal. Text that is not a number is unchanged.
[[nodiscard]] ValueSpelling spell_number(std::string_view text, unsigned hex_digits);

/// A value of an entry of this type: default value, limit or parameter value. With the number of hexadecimal digits of
/// the type, and formulas as `$NODEID+0x180`; strings and invalid values are unchanged.
[[nodiscard]] ValueSpelling spell_value(std::string_view text, const canopen::DataTypeRow& type);

/// An index, or a range of indices: `0xA080-0xA0BF`. Other text is unchanged.
[[nodiscard]] ValueSpelling spell_index_range(std::string_view text, unsigned hex_digits);

/// A Count of a module: `n` or `0;m`. Other text is unchanged.
[[nodiscard]] ValueSpelling spell_module_count(std::string_view text);

/// The inline comment after a number, from its `;` or `#`; may be empty.
[[nodiscard]] std::string_view inline_comment(std::string_view text);

/// An AccessType in lower case; other text is unchanged.
[[nodiscard]] ValueSpelling spell_access(std::string_view text);

/// The number of hexadecimal digits of a type.
[[nodiscard]] unsigned hex_digits_of(const canopen::DataTypeRow& type);

}  // namespace edsc
