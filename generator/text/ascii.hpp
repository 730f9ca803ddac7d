/// ASCII letters, digits and blanks, independent of the locale.
#pragma once

#include <cstddef>
#include <string_view>

namespace edsc {

[[nodiscard]] constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
[[nodiscard]] constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
[[nodiscard]] constexpr bool is_letter(char c) { return is_lower(c) || is_upper(c); }

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

[[nodiscard]] constexpr bool is_hex_digit(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

[[nodiscard]] constexpr char to_lower(char c) { return is_upper(c) ? static_cast<char>(c + ('a' - 'A')) : c; }
[[nodiscard]] constexpr char to_upper(char c) { return is_lower(c) ? static_cast<char>(c - ('a' - 'A')) : c; }

/// Space and tab; Ctrl-Z, with which DOS programs end a text, and NUL, with which some tools fill the last block: both
/// are rejected anywhere else.
[[nodiscard]] constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\x1A' || c == '\0'; }

[[nodiscard]] constexpr std::string_view trim_left(std::string_view text) {
  std::size_t blanks = 0;
  while (blanks < text.size() && is_blank(text[blanks])) {
    ++blanks;
  }
  return text.substr(blanks);
}

[[nodiscard]] constexpr std::string_view trim_right(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

[[nodiscard]] constexpr std::string_view trim(std::string_view text) { return trim_right(trim_left(text)); }

}  // namespace edsc
