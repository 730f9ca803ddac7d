/// Words and numbers of a line of a log.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "text/ascii.hpp"
#include "text/number_text.hpp"
#include "values/append.hpp"

namespace edsc {

/// Removes the next word and the blanks before it from the text. Empty at the end.
inline std::string_view take_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

/// `1436509052.249713` as an integer of 10^-`decimals`; further digits are truncated. At most 12 digits before the
/// point.
[[nodiscard]] inline std::optional<std::int64_t> parse_decimal(std::string_view text, std::size_t decimals) {
  constexpr std::size_t max_digits = 12;
  std::int64_t number = 0;
  std::size_t at = 0;
  for (; at < text.size() && is_digit(text[at]); ++at) {
    if (at == max_digits) return std::nullopt;
    number = number * 10 + (text[at] - '0');
  }
  if (at == 0) return std::nullopt;
  std::size_t found = 0;
  if (at < text.size() && text[at] == '.') {
    for (++at; at < text.size() && is_digit(text[at]); ++at) {
      if (++found <= decimals) number = number * 10 + (text[at] - '0');
    }
  }
  for (; found < decimals; ++found) number *= 10;
  return at == text.size() ? std::optional{number} : std::nullopt;
}

/// `1436509052.249713`
inline void append_seconds(std::string& out, std::int64_t microseconds) {
  constexpr std::int64_t second = 1'000'000;
  append_decimal(out, microseconds / second);
  out += '.';
  const fmt::format_int digits{microseconds % second};
  out.append(6 - digits.size(), '0').append(digits.data(), digits.size());
}

[[nodiscard]] inline bool is_number(std::string_view word) {
  return !word.empty() && std::ranges::all_of(word, is_digit);
}

/// Without regard to the case of letters.
[[nodiscard]] inline bool is_word(std::string_view word, std::string_view lower) {
  return std::ranges::equal(word, lower, {}, to_lower);
}

}  // namespace edsc
