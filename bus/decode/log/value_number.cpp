#include "decode/log/value_number.hpp"

#include <fmt/compile.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "device/meaning/physical.hpp"
#include "values/append.hpp"
#include "values/little_endian.hpp"

namespace edsc {

std::optional<ValueNumber> plain_number(const MessageValue& value) {
  using canopen::DataClass;
  const unsigned bits = value.bits != 0 ? value.bits : static_cast<unsigned>(value.bytes.size()) * 8;
  if (bits == 0 || bits > 64 || value.type == nullptr) return std::nullopt;
  const std::uint64_t number = value.bits != 0 ? value.number : number_of(value.bytes);
  switch (value.type->kind) {
    case DataClass::boolean: return number != 0;
    case DataClass::unsigned_integer: return number;
    case DataClass::signed_integer: return std::int64_t{sign_extended(number, bits)};
    case DataClass::real:
      if (bits == 32) return std::bit_cast<float>(static_cast<std::uint32_t>(number));
      if (bits == 64) return std::bit_cast<double>(number);
      return std::nullopt;
    case DataClass::time:
    case DataClass::string:
    case DataClass::domain: break;
  }
  return std::nullopt;
}

std::optional<double> physical_number(const MessageValue& value) {
  if (value.quantity == nullptr) return std::nullopt;
  const Quantity& quantity = *value.quantity;
  const auto raw = plain_number(value);
  if (!raw) return std::nullopt;
  double physical = std::visit([](auto of) { return static_cast<double>(of); }, *raw);
  if (!quantity.is_raw()) {
    const std::uint64_t bits = value.bits != 0 ? value.number : number_of(value.bytes);
    const auto exact = physical_value(quantity, *value.type, bits);
    physical = exact ? exact->to_double() : physical * quantity.scale.to_double() + quantity.offset.to_double();
  }
  return std::isfinite(physical) ? std::optional{physical} : std::nullopt;
}

std::optional<std::int64_t> integer_of(const MessageValue& value) {
  const auto number = plain_number(value);
  if (!number) return std::nullopt;
  if (const auto* const whole = std::get_if<std::uint64_t>(&*number)) return static_cast<std::int64_t>(*whole);
  if (const auto* const whole = std::get_if<std::int64_t>(&*number)) return *whole;
  return std::nullopt;
}

std::optional<double> finite_number_of(const MessageValue& value) {
  if (value.quantity != nullptr) return physical_number(value);
  const auto number = plain_number(value);
  if (!number) return std::nullopt;
  const double real = std::visit([](auto of) { return static_cast<double>(of); }, *number);
  return std::isfinite(real) ? std::optional{real} : std::nullopt;
}

void append_number(std::string& out, const ValueNumber& number) {
  std::visit(
      [&out](auto of) {
        if constexpr (std::is_integral_v<decltype(of)> && !std::is_same_v<decltype(of), bool>) {
          append_decimal(out, of);
        } else {
          fmt::format_to(std::back_inserter(out), FMT_COMPILE("{}"), of);
        }
      },
      number);
}

}  // namespace edsc
