/// Numbers in the notation of CiA 306-1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace edsc {

struct Field;

/// Reads a decimal, hexadecimal (0x) or octal (leading 0) number, also with `+` and with blanks around it. Returns
/// nothing if any other text remains, or if the number exceeds 64 bits.
[[nodiscard]] std::optional<std::uint64_t> parse_unsigned(std::string_view text);

/// The same without octal numbers: a version 08 is eight, 010 is ten.
[[nodiscard]] std::optional<std::uint64_t> parse_decimal(std::string_view text);

/// Whether a leading 0 changes the value: 010 is eight.
[[nodiscard]] bool is_octal(std::string_view text);

/// Reads hexadecimal digits without prefix, as in section and key names: one to `max_digits`, at most four.
[[nodiscard]] std::optional<std::uint16_t> parse_hex(std::string_view text, std::size_t max_digits);

/// Removes `;` or `#`, the text after it, and the blanks before it. Only for values that contain neither: numbers,
/// codes.
[[nodiscard]] std::string_view strip_inline_comment(std::string_view text);

/// Returns the number of a key, without an inline comment.
[[nodiscard]] std::optional<std::uint64_t> number_of(const Field& field);

}  // namespace edsc
