/// Numbers as users write them.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <system_error>

namespace edsc {

/// The number that the whole text is; nothing for any other text, and if it does not fit.
template <class Number>
[[nodiscard]] std::optional<Number> parse_whole(std::string_view text, int base = 10) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number, base);
  return parsed.ec == std::errc{} && parsed.ptr == end ? std::optional{number} : std::nullopt;
}

/// The N numbers of a text of this form, such as `00-00-0000`: a digit for each 0, all else as it is.
template <std::size_t N>
[[nodiscard]] std::optional<std::array<unsigned, N>> parse_form(std::string_view text, std::string_view form) {
  if (text.size() != form.size()) return std::nullopt;
  std::array<unsigned, N> numbers{};
  std::size_t number = 0;
  for (std::size_t i = 0; i < form.size(); ++i) {
    if (form[i] != '0' ? text[i] != form[i] : text[i] < '0' || text[i] > '9') return std::nullopt;
    if (form[i] == '0') {
      numbers[number] = numbers[number] * 10 + static_cast<unsigned>(text[i] - '0');
    } else {
      ++number;
    }
  }
  return numbers;
}

/// Digits without the mark of their base.
struct Digits {
  std::string_view text;
  int base = 10;
};

/// `0x1F` and `1Fh` have the base 16; other texts have `unmarked`.
[[nodiscard]] constexpr Digits digits_of(std::string_view text, int unmarked = 10) {
  if (text.starts_with("0x") || text.starts_with("0X")) return {text.substr(2), 16};
  if (text.ends_with('h') || text.ends_with('H')) return {text.substr(0, text.size() - 1), 16};
  return {text, unmarked};
}

}  // namespace edsc
