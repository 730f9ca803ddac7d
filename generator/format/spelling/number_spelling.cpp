#include "format/spelling/number_spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <optional>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

using canopen::DataClass;

constexpr std::string_view node_id_spellings[] = {"$NODEID", "$NODE_ID", "$MY_NODE_ID"};

bool is_decimal(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_digit); }

ValueSpelling unchanged(std::string_view text) { return {std::string{text}, {}}; }

std::optional<std::string> spell_magnitude(std::string_view digits, unsigned hex_digits) {
  const auto number = parse_unsigned(digits);
  if (!number) return std::nullopt;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  if (is_hexadecimal(digits)) return fmt::format("0x{:0{}X}", *number, hex_digits);
  if (digits.starts_with('0') && *number > 7) return fmt::format("0{:o}", *number);
  return fmt::format("{}", *number);
}

/// `0089` has a leading 0, but is decimal.
std::optional<std::string> spell_decimal(std::string_view digits) {
  if (!is_decimal(digits)) return std::nullopt;
  const std::size_t zeros = std::min(digits.find_first_not_of('0'), digits.size() - 1);
  return std::string{digits.substr(zeros)};
}

std::optional<std::string> spell_integer(std::string_view text, unsigned hex_digits) {
  const bool is_negative = text.starts_with('-');
  const std::string_view digits = is_negative ? trim(text.substr(1)) : text;
  auto magnitude = spell_magnitude(without_c_suffix(digits), hex_digits);
  if (!magnitude) magnitude = spell_decimal(digits);
  if (!magnitude) return std::nullopt;
  return (is_negative ? "-" : "") + *magnitude;
}

/// The bit pattern in hexadecimal, or an unchanged decimal number.
std::optional<std::string> spell_real(std::string_view text, unsigned hex_digits) {
  if (is_hexadecimal(text)) return spell_magnitude(text, hex_digits);
  if (!parse_real(text)) return std::nullopt;
  return std::string{text.starts_with('+') ? text.substr(1) : text};
}

bool is_node_id(std::string_view text) {
  return std::ranges::any_of(node_id_spellings, [&](std::string_view word) { return equal_ignoring_case(text, word); });
}

std::optional<std::string> spell_formula(std::string_view text) {
  const auto [variable, constant] = split_formula(text);
  if (!is_node_id(variable)) return std::nullopt;
  if (!constant) return "$NODEID";
  const auto number = spell_magnitude(without_c_suffix(*constant), 1);
  if (!number) return std::nullopt;
  return "$NODEID+" + *number;
}

std::optional<std::string> spell_by_type(std::string_view text, const canopen::DataTypeRow& type) {
  const unsigned digits = hex_digits_of(type);
  switch (type.kind) {
    case DataClass::unsigned_integer:
    case DataClass::signed_integer:
      return text.find('$') != std::string_view::npos ? spell_formula(text) : spell_integer(text, digits);
    case DataClass::boolean:
    case DataClass::time: return spell_integer(text, digits);
    case DataClass::real: return spell_real(text, digits);
    case DataClass::string:
    case DataClass::domain: break;
  }
  return std::nullopt;
}

/// Two numbers with a separator between them, or one number without it.
std::optional<std::string> spell_pair(std::string_view text, char separator, unsigned hex_digits) {
  const std::size_t middle = text.find(separator);
  const auto first = spell_magnitude(trim(text.substr(0, middle)), hex_digits);
  if (!first || middle == std::string_view::npos) return first;
  const auto second = spell_magnitude(trim(text.substr(middle + 1)), hex_digits);
  if (!second) return std::nullopt;
  return fmt::format("{}{}{}", *first, separator, *second);
}

}  // namespace

std::string_view inline_comment(std::string_view text) {
  const std::size_t start = text.find_first_of(";#");
  if (start == std::string_view::npos || trim(text.substr(start + 1)).empty()) return {};
  return trim(text.substr(start));
}

unsigned hex_digits_of(const canopen::DataTypeRow& type) { return (type.bits + 3U) / 4U; }

ValueSpelling spell_number(std::string_view text, unsigned hex_digits) {
  const auto number = spell_magnitude(strip_inline_comment(text), hex_digits);
  return number ? ValueSpelling{*number, inline_comment(text)} : unchanged(text);
}

ValueSpelling spell_value(std::string_view text, const canopen::DataTypeRow& type) {
  const auto value = spell_by_type(strip_inline_comment(text), type);
  return value ? ValueSpelling{*value, inline_comment(text)} : unchanged(text);
}

ValueSpelling spell_index_range(std::string_view text, unsigned hex_digits) {
  const auto range = spell_pair(strip_inline_comment(text), '-', hex_digits);
  return range ? ValueSpelling{*range, inline_comment(text)} : unchanged(text);
}

ValueSpelling spell_module_count(std::string_view text) {
  const auto count = spell_pair(text, ';', 1);
  return count ? ValueSpelling{*count, {}} : unchanged(text);
}

ValueSpelling spell_access(std::string_view text) {
  const std::string_view word = strip_inline_comment(text);
  for (const canopen::AccessRow& row : canopen::access_rows) {
    if (equal_ignoring_case(word, row.name)) return {std::string{row.name}, inline_comment(text)};
  }
  return unchanged(text);
}

}  // namespace edsc
