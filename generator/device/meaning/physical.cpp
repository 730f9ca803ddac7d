#include "device/meaning/physical.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "text/ascii.hpp"
#include "values/little_endian.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;

bool is_integer(const DataTypeRow& type) {
  return type.kind == DataClass::unsigned_integer || type.kind == DataClass::signed_integer;
}

/// Nothing for an UNSIGNED64 above the range of int64.
std::optional<std::int64_t> integer_of(const DataTypeRow& type, std::uint64_t bits) {
  if (type.kind == DataClass::signed_integer) return sign_extended(bits, type.bits);
  if (bits > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return std::nullopt;
  return static_cast<std::int64_t>(bits);
}

double real_of(const DataTypeRow& type, std::uint64_t bits) {
  if (type.bits == 32) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  return std::bit_cast<double>(bits);
}

/// Decimals that distinguish neighbouring raw numbers: a hundredth of the scale, at most 12.
unsigned decimals_of(const Quantity& quantity) {
  constexpr unsigned max_decimals = 12;
  const double step = std::abs(quantity.scale.to_double());
  unsigned decimals = 0;
  for (double unit = 1; decimals < max_decimals && unit > step / 100; unit /= 10) ++decimals;
  return decimals;
}

std::string number_text(const Rational& number, const Quantity& quantity) {
  return decimal_text(number, decimals_of(quantity));
}

std::string with_unit(const Rational& number, const Quantity& quantity) {
  std::string text = number_text(number, quantity);
  append_unit(text, quantity.symbol);
  return text;
}

/// The raw integer that is not above a physical value, and whether it is that value.
struct Floor {
  std::int64_t raw;
  bool is_exact;
};
std::optional<Floor> raw_floor(const Quantity& quantity, const Rational& value) {
  const auto above = difference(value, quantity.offset);
  const auto raw = above ? quotient(*above, quantity.scale) : std::nullopt;
  if (!raw) return std::nullopt;
  return Floor{floor_of(*raw), raw->is_integer()};
}

/// Whether the integer is a value of the type.
bool is_in_type(const DataTypeRow& type, std::int64_t raw) {
  if (type.kind == DataClass::unsigned_integer) {
    return raw >= 0 && (type.bits >= 64 || (static_cast<std::uint64_t>(raw) >> type.bits) == 0);
  }
  if (type.bits >= 64) return true;
  const std::int64_t half = std::int64_t{1} << (type.bits - 1);
  return raw >= -half && raw < half;
}

std::uint64_t bits_of(const DataTypeRow& type, std::int64_t raw) {
  const auto bits = static_cast<std::uint64_t>(raw);
  return type.bits >= 64 ? bits : bits & ((std::uint64_t{1} << type.bits) - 1);
}

std::optional<Rational> physical_of(const Quantity& quantity, std::int64_t raw) {
  const auto scaled = product(Rational{raw}, quantity.scale);
  return scaled ? sum(*scaled, quantity.offset) : std::nullopt;
}

RawNumber real_number(const Quantity& quantity, const DataTypeRow& type, const Rational& value) {
  const double raw = (value.to_double() - quantity.offset.to_double()) / quantity.scale.to_double();
  if (type.bits == 32) return {std::bit_cast<std::uint32_t>(static_cast<float>(raw)), ""};
  return {std::bit_cast<std::uint64_t>(raw), ""};
}

}  // namespace

Rational rational(const canopen::Fraction& fraction) { return *Rational::of(fraction.numerator, fraction.denominator); }

std::optional<Rational> physical_value(const Quantity& quantity, const DataTypeRow& type, std::uint64_t bits) {
  if (!is_integer(type)) return std::nullopt;
  const auto raw = integer_of(type, bits);
  return raw ? physical_of(quantity, *raw) : std::nullopt;
}

void append_physical(std::string& text, const Quantity& quantity, const DataTypeRow& type, std::uint64_t bits,
                     unsigned length) {
  if (quantity.is_raw()) return append_number(text, type, bits, length, quantity.symbol);
  if (type.kind == DataClass::real) {
    fmt::format_to(std::back_inserter(text), "{:.9g}",
                   real_of(type, bits) * quantity.scale.to_double() + quantity.offset.to_double());
    return append_unit(text, quantity.symbol);
  }
  const auto value = physical_value(quantity, type, bits);
  if (!value) return append_number(text, type, bits, length);
  text += with_unit(*value, quantity);
}

std::optional<PhysicalText> split_physical(std::string_view text) {
  text = trim(text);
  std::size_t end = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::size_t first_digit = end;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
  if (end == first_digit) return std::nullopt;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t exponent = end + 1;
    if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
    const std::size_t first = exponent;
    while (exponent < text.size() && is_digit(text[exponent])) ++exponent;
    if (exponent != first) end = exponent;
  }
  const PhysicalText parts{text.substr(0, end), trim(text.substr(end))};
  return parts.unit.empty() ? std::nullopt : std::optional{parts};
}

RawNumber raw_number(const Quantity& quantity, const DataTypeRow& type, const PhysicalText& text) {
  const auto fail = [&](std::string problem) { return RawNumber{0, std::move(problem)}; };
  auto value = parse_rational(text.number);
  if (!value) return fail(fmt::format("\"{}\" is not a decimal number", text.number));
  if (text.unit != quantity.symbol) {
    const canopen::UnitRow* const unit = canopen::find_unit(text.unit);
    if (unit == nullptr) return fail(fmt::format("\"{}\" is not a unit that edsc knows", text.unit));
    if (quantity.unit == nullptr || unit->dimension != quantity.unit->dimension) {
      return fail(fmt::format("{} cannot be converted to {}", unit->symbol,
                              quantity.symbol.empty() ? "a number without a unit" : quantity.symbol));
    }
    if (unit != quantity.unit) {
      if (!canopen::is_exact_conversion(*unit, *quantity.unit)) {
        return fail(fmt::format("{} cannot be converted to {} exactly", unit->symbol, quantity.symbol));
      }
      const auto scaled = product(*value, rational(unit->factor));
      const auto offset = difference(rational(unit->offset), rational(quantity.unit->offset));
      const auto base = scaled && offset ? sum(*scaled, *offset) : std::nullopt;
      value = base ? quotient(*base, rational(quantity.unit->factor)) : std::nullopt;
      if (!value) return fail(fmt::format("{} {} is out of range", text.number, text.unit));
    }
  }
  if (type.kind == DataClass::real) return real_number(quantity, type, *value);
  const auto floor = raw_floor(quantity, *value);
  if (!floor) return fail(fmt::format("{} {} is out of range", text.number, text.unit));
  if (!floor->is_exact) {
    // A number without a finite decimal is accepted as edsc prints it.
    for (const std::int64_t raw : {floor->raw, floor->raw + 1}) {
      const auto physical = physical_of(quantity, raw);
      if (physical && text.unit == quantity.symbol && number_text(*physical, quantity) == text.number &&
          is_in_type(type, raw)) {
        return {bits_of(type, raw), ""};
      }
    }
    const auto below = physical_of(quantity, floor->raw), above = physical_of(quantity, floor->raw + 1);
    if (!below || !above) return fail(fmt::format("{} {} is out of range", text.number, text.unit));
    const bool is_descending = *above < *below;
    return fail(fmt::format("{} {} is between {} and {}", text.number, text.unit,
                            with_unit(is_descending ? *above : *below, quantity),
                            with_unit(is_descending ? *below : *above, quantity)));
  }
  if (!is_in_type(type, floor->raw))
    return fail(fmt::format("{} {} is outside the range of {}", text.number, text.unit, type.name));
  return {bits_of(type, floor->raw), ""};
}

}  // namespace edsc
