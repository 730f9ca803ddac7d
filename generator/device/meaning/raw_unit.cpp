#include "device/meaning/raw_unit.hpp"

#include <fmt/format.h>

#include "device/meaning/physical.hpp"

namespace edsc {
namespace {

std::string number_in_unit(const Rational& number, const Quantity& quantity) {
  const std::string text = number.is_integer() ? decimal_text(number) : fmt::format("{}", number.to_double());
  return quantity.symbol.empty() ? text : text + " " + quantity.symbol;
}

/// The scale and offset in the base unit of the dimension; nothing if they do not fit.
struct InBaseUnit {
  std::optional<Rational> scale, offset;
};

InBaseUnit in_base_unit(const Quantity& quantity) {
  const Rational factor = rational(quantity.unit->factor);
  const auto offset = product(quantity.offset, factor);
  return {product(quantity.scale, factor), offset ? sum(*offset, rational(quantity.unit->offset)) : std::nullopt};
}

}  // namespace

std::string raw_unit_text(const Quantity& quantity) {
  if (quantity.is_raw()) return quantity.symbol;
  std::string text = quantity.scale == Rational{1} && !quantity.symbol.empty()
                         ? quantity.symbol
                         : number_in_unit(quantity.scale, quantity);
  if (quantity.offset != Rational{0}) text += ", 0 is " + number_in_unit(quantity.offset, quantity);
  return text;
}

bool has_same_raw_numbers(const Quantity& a, const Quantity& b) {
  if (a.unit == b.unit && (a.unit != nullptr || a.symbol == b.symbol)) {
    return a.scale == b.scale && a.offset == b.offset;
  }
  if (a.unit == nullptr || b.unit == nullptr || a.unit->dimension != b.unit->dimension) return false;
  const InBaseUnit one = in_base_unit(a), other = in_base_unit(b);
  return one.scale && one.offset && one.scale == other.scale && one.offset == other.offset;
}

}  // namespace edsc
