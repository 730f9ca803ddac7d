#include "eds/number.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

#include "eds/data_sheet.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// Removes the prefix for the base; "0" alone is a decimal number.
int take_base(std::string_view& text) {
  if (is_hexadecimal(text)) {
    text.remove_prefix(2);
    return 16;
  }
  if (text.size() > 1 && text.starts_with('0')) {
    text.remove_prefix(1);
    return 8;
  }
  return 10;
}

}  // namespace

std::optional<std::uint64_t> parse_unsigned(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const int base = take_base(text);
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, number, base);
  if (result.ec != std::errc() || result.ptr != end) {
    return std::nullopt;
  }
  return number;
}

std::optional<std::uint64_t> parse_h_suffix(std::string_view text) {
  // A word such as `beach` is not a number, `FFh` is.
  const bool has_digit =
      !text.empty() && (is_digit(text.front()) || (is_hex_digit(text.front()) && !is_lower(text.front())));
  if (text.size() < 2 || !has_digit || to_lower(text.back()) != 'h') return std::nullopt;
  std::string digits{"0x"};
  for (const char c : text.substr(0, text.size() - 1)) {
    if (!is_blank(c)) digits += c;
  }
  return parse_unsigned(digits);
}

std::string_view without_quotes(std::string_view text) {
  const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return is_quoted ? trim(text.substr(1, text.size() - 2)) : text;
}

std::optional<std::uint64_t> parse_decimal(std::string_view text) {
  text = trim(text);
  while (text.size() > 1 && text[0] == '0' && is_digit(text[1])) text.remove_prefix(1);
  return parse_unsigned(text);
}

std::optional<double> parse_real(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = result.ec == std::errc{} && result.ptr == text.data() + text.size();
  return is_whole ? std::optional{value} : std::nullopt;
}

bool is_hexadecimal(std::string_view digits) { return digits.starts_with("0x") || digits.starts_with("0X"); }

std::string_view without_c_suffix(std::string_view digits) {
  while (digits.size() > 1 && std::string_view{"uUlL"}.find(digits.back()) != std::string_view::npos) {
    digits.remove_suffix(1);
  }
  return digits;
}

Formula split_formula(std::string_view text) {
  const std::size_t plus = text.find('+');
  const std::string_view first = trim(text.substr(0, plus));
  if (plus == std::string_view::npos) return {first, std::nullopt};
  const std::string_view second = trim(text.substr(plus + 1));
  return first.starts_with('$') ? Formula{first, second} : Formula{second, first};
}

bool is_octal(std::string_view text) {
  text = trim(text);
  const auto is_octal_digit = [](char c) { return c >= '0' && c <= '7'; };
  return text.starts_with('0') && std::all_of(text.begin(), text.end(), is_octal_digit) &&
         parse_unsigned(text).value_or(0) >= 8;
}

std::optional<std::uint16_t> parse_hex(std::string_view text, std::size_t max_digits) {
  if (text.empty() || text.size() > max_digits || !std::all_of(text.begin(), text.end(), is_hex_digit)) {
    return std::nullopt;
  }
  std::uint16_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number, 16);
  return number;
}

std::string_view strip_inline_comment(std::string_view text) { return trim(text.substr(0, text.find_first_of(";#"))); }

std::optional<std::uint64_t> number_of(const Field& field) { return parse_unsigned(strip_inline_comment(field.text)); }

}  // namespace edsc
