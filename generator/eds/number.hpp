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

/// `80h`, `0000 0080h`: the notation of manuals and CiA documents.
[[nodiscard]] std::optional<std::uint64_t> parse_h_suffix(std::string_view text);

/// The text between quotation marks; the same text without them.
[[nodiscard]] std::string_view without_quotes(std::string_view text);

/// `parse_unsigned` without octal numbers: a version 08 is eight, 010 is ten.
[[nodiscard]] std::optional<std::uint64_t> parse_decimal(std::string_view text);

/// Reads a decimal number with a fraction or exponent, also with `+`. Returns nothing if any other text remains.
[[nodiscard]] std::optional<double> parse_real(std::string_view text);

/// Whether a number begins with 0x.
[[nodiscard]] bool is_hexadecimal(std::string_view digits);

/// `12LL`, `0xFFu`: removes C suffixes, which are not allowed in an EDS.
[[nodiscard]] std::string_view without_c_suffix(std::string_view digits);

/// The parts of `$NODEID+0x180` and `0x180 + $NodeID` (CiA 306-1, 4.6.2.3), without blanks around them.
struct Formula {
  std::string_view variable;                 ///< with its `$`
  std::optional<std::string_view> constant;  ///< nothing for the variable alone
};
[[nodiscard]] Formula split_formula(std::string_view text);

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
