/// UTF-8, the encoding of all texts in the generator.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace edsc {

inline constexpr char32_t replacement_character = 0xFFFD;

/// Returns the length of the well-formed sequence that `text` begins with, or 0.
[[nodiscard]] std::size_t utf8_sequence_length(std::string_view text);

[[nodiscard]] bool is_ascii(std::string_view text);
[[nodiscard]] bool is_utf8(std::string_view text);

void append_utf8(std::string& text, char32_t code_point);

/// Returns true for every byte of a code point except its first.
[[nodiscard]] constexpr bool is_utf8_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Code points beyond FFFFh as two surrogates.
[[nodiscard]] std::u16string to_utf16(std::string_view text);

[[nodiscard]] std::size_t count_code_points(std::string_view text);

}  // namespace edsc
