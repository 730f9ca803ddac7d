/// Numbers as CiA 306-1 writes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace edsc {

struct Field;

/// A decimal, hexadecimal (0x) or octal (leading 0) number, blanks around it cut, a `+` before it let through. Nothing
/// when any of the text is not part of the number, or when 64 bits do not hold it.
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// The same where a leading 0 does not make a number octal: a version 08 is eight, 010 is ten.
[[nodiscard]] std::optional<std::uint64_t> parse_decimal(std::string_view text);

/// Whether a leading 0 makes it another number than its digits: 010 is eight.
[[nodiscard]] bool is_octal(std::string_view text);

/// Hexadecimal digits without prefix, as section and key names hold them: one to `most_digits`, four at most.
[[nodiscard]] std::optional<std::uint16_t> parse_hex(std::string_view text, std::size_t most_digits);

/// Cuts what follows a `;` or `#`, and the blanks before that. Only for values that hold neither: numbers and codes.
[[nodiscard]] std::string_view strip_inline_comment(std::string_view text);

/// The number that a key holds, with what follows a `;` or `#` cut.
[[nodiscard]] std::optional<std::uint64_t> number_of(const Field& field);

}  // namespace edsc
