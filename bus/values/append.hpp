/// Appends numbers to a text without a format string: a log of a million frames has ten million of them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

inline constexpr std::string_view upper_hex_digits = "0123456789ABCDEF";

inline void append_decimal(std::string& text, std::uint64_t number) {
  const fmt::format_int digits{number};
  text.append(digits.data(), digits.size());
}

inline void append_signed_decimal(std::string& text, std::int64_t number) {
  const fmt::format_int digits{number};
  text.append(digits.data(), digits.size());
}

/// The given number of upper-case digits; higher digits are truncated.
inline void append_hex(std::string& text, std::uint64_t number, unsigned digits) {
  char buffer[16];
  for (unsigned i = digits; i-- > 0; number >>= 4) buffer[i] = upper_hex_digits[number & 0xF];
  text.append(buffer, digits);
}

/// `0A`
inline void append_hex_byte(std::string& text, std::uint8_t byte) {
  const char pair[] = {upper_hex_digits[byte >> 4], upper_hex_digits[byte & 0xF]};
  text.append(pair, sizeof pair);
}

/// `6064h:00`
inline void append_entry_label(std::string& text, std::uint16_t index, std::uint8_t sub_index) {
  append_hex(text, index, 4);
  text += "h:";
  append_hex_byte(text, sub_index);
}

}  // namespace edsc
