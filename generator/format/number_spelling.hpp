/// How the canonical form spells numbers: base and value stay, the spelling is one.
#pragma once

#include <canopen/data_type.hpp>
#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

struct Spelling {
  std::string text;
  std::string_view remark;  ///< an inline comment that stood behind the value, with its `;` or `#`; may be empty
};

/// A number of the data sheet's own keys, such as DataType or VendorNumber: `0x` and upper-case digits, `hex_digits` at
/// least; or decimal, or octal. What is no number stays as it is.
[[nodiscard]] Spelling spell_number(std::string_view text, unsigned hex_digits);

/// A value of an entry of this type: default, limit or parameter value. Hexadecimal digits as many as the type has,
/// formulas as `$NODEID+0x180`; strings, and what is no value of the type, stay as they are.
[[nodiscard]] Spelling spell_value(std::string_view text, const canopen::DataTypeRow& type);

/// An AccessType in lower case; what is none stays as it is.
[[nodiscard]] Spelling spell_access(std::string_view text);

/// How many hexadecimal digits a type has.
[[nodiscard]] unsigned hex_digits_of(const canopen::DataTypeRow& type);

}  // namespace edsc
