/// UTF-8, the encoding of all texts in the generator, and its conversion from and to UTF-16.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

inline constexpr char32_t replacement_character = 0xFFFD;

/// Returns the length of the well-formed sequence that `text` begins with, or 0.
[[nodiscard]] std::size_t utf8_sequence_length(std::string_view text);

/// Returns the code point of a well-formed sequence.
[[nodiscard]] char32_t code_point_of(std::string_view sequence);

[[nodiscard]] bool is_ascii(std::string_view text);
[[nodiscard]] bool is_utf8(std::string_view text);

void append_utf8(std::string& text, char32_t code_point);

/// Returns true for every byte of a code point except its first.
[[nodiscard]] constexpr bool is_utf8_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Calls `use` for each code point; for a byte that does not begin a well-formed sequence, with U+FFFD.
template <typename Use>
void for_each_code_point(std::string_view text, Use use) {
  while (!text.empty()) {
    const std::size_t length = utf8_sequence_length(text);
    use(length == 0 ? replacement_character : code_point_of(text.substr(0, length)));
    text.remove_prefix(length == 0 ? 1 : length);
  }
}

/// Code points beyond FFFFh as two surrogates.
[[nodiscard]] std::u16string to_utf16(std::string_view text);
/// The bytes of a UNICODE_STRING: UTF-16, low byte first.
[[nodiscard]] std::string to_utf16_bytes(std::string_view text);

enum class ByteOrder : std::uint8_t { low_first, high_first };
/// A surrogate without its partner, and an odd byte at the end, become U+FFFD.
[[nodiscard]] std::string from_utf16_bytes(std::string_view bytes, ByteOrder order);

[[nodiscard]] std::size_t count_code_points(std::string_view text);

}  // namespace edsc
