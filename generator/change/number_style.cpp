#include "change/number_style.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "change/sheet_edit.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

std::string without_h_suffix(std::string_view value) {
  const auto number = parse_unsigned(value) ? std::nullopt : parse_h_suffix(value);
  return number ? fmt::format("0x{:X}", *number) : std::string{value};
}

std::string restyled_number(const std::string& value, std::string_view like) {
  const auto number = parse_unsigned(value);
  const auto old_number = parse_unsigned(like);
  if (!number || !old_number) return value;
  if (*number == *old_number) return std::string{like};
  return like == "0" || is_octal(like) ? value : spelled_like(*number, like);
}

}  // namespace

std::string restyled(std::string_view value, std::string_view like) {
  const Formula formula = split_formula(value);
  if (!formula.variable.starts_with('$')) return restyled_number(without_h_suffix(value), like);
  const Formula old_formula = split_formula(like);
  if (!old_formula.variable.starts_with('$') || !old_formula.constant || !formula.constant) return std::string{value};
  const auto start = static_cast<std::size_t>(old_formula.constant->data() - like.data());
  std::string text{like.substr(0, start)};
  text += restyled_number(without_h_suffix(*formula.constant), *old_formula.constant);
  text += like.substr(start + old_formula.constant->size());
  return text;
}

}  // namespace edsc
