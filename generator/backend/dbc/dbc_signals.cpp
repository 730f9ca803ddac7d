#include "backend/dbc/dbc_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "device/meaning/physical.hpp"
#include "device/meaning/value_parts.hpp"
#include "values/little_endian.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataTypeRow;

[[nodiscard]] std::string number_text(const Rational& number) {
  return number.is_integer() ? fmt::format("{}", number.numerator()) : fmt::format("{}", number.to_double());
}

/// The symbol of the unit, or its ASCII spelling if code page 1252 does not have the symbol.
[[nodiscard]] std::string unit_text(const Quantity& quantity) {
  if (quantity.unit == nullptr) return quantity.symbol;
  constexpr unsigned char last_lead_byte = 0xC3;  // of the UTF-8 characters up to U+00FF
  const bool is_in_code_page = std::ranges::all_of(
      quantity.unit->symbol, [](char c) { return static_cast<unsigned char>(c) <= last_lead_byte; });
  return std::string{is_in_code_page ? quantity.unit->symbol : quantity.unit->ascii};
}

/// A raw value as the signal has it.
[[nodiscard]] std::string physical_text(std::uint64_t bits, const DataTypeRow& type, const Quantity& quantity) {
  const double scale = quantity.scale.to_double(), offset = quantity.offset.to_double();
  if (type.kind == DataClass::real) {
    return quantity.is_raw() ? real_text(bits, type) : fmt::format("{}", real_of(bits, type) * scale + offset);
  }
  const auto number = static_cast<std::int64_t>(bits);
  const bool is_signed = type.kind == DataClass::signed_integer;
  if (quantity.is_raw()) return is_signed ? fmt::format("{}", number) : fmt::format("{}", bits);
  if (const auto value = physical_value(quantity, type, bits)) return number_text(*value);
  return fmt::format("{}", (is_signed ? static_cast<double>(number) : static_cast<double>(bits)) * scale + offset);
}

/// A signal of the bits of a type, with the limits of the type.
void set_quantity(DbcSignal& signal, const Quantity& quantity, const DataTypeRow& type, std::uint64_t low,
                  std::uint64_t high) {
  signal.factor = number_text(quantity.scale);
  signal.offset = number_text(quantity.offset);
  signal.unit = unit_text(quantity);
  signal.min = physical_text(low, type, quantity);
  signal.max = physical_text(high, type, quantity);
  if (quantity.scale < Rational{0}) std::swap(signal.min, signal.max);
}

[[nodiscard]] std::uint64_t lowest_of(unsigned bits, bool is_signed) { return is_signed ? ~(low_bits(bits) >> 1) : 0; }

[[nodiscard]] std::uint64_t highest_of(unsigned bits, bool is_signed) {
  return is_signed ? low_bits(bits) >> 1 : low_bits(bits);
}

/// The limits are those of the EDS, else those of the type. A real number with one limit has none.
[[nodiscard]] DbcSignal whole_entry(const Entry& entry, unsigned bits) {
  using enum DataClass;
  const DataTypeRow& type = *entry.type;
  DbcSignal signal;
  signal.bits = bits;
  signal.is_signed = type.kind == signed_integer;
  const bool is_number = type.kind == boolean || type.kind == unsigned_integer || signal.is_signed || type.kind == real;
  if (!is_number) {
    signal.text = fmt::format("{} as a number", type.name);
    return signal;
  }
  const Meaning* const meaning = entry.meaning.get();
  if (meaning != nullptr && meaning->values) signal.values = &*meaning->values;
  const Quantity quantity = meaning != nullptr && meaning->quantity ? *meaning->quantity : Quantity{};
  set_quantity(signal, quantity, type, entry.low_limit ? entry.low_limit->bits : lowest_of(type.bits, signal.is_signed),
               entry.high_limit ? entry.high_limit->bits : highest_of(type.bits, signal.is_signed));
  if (type.kind == real && !(entry.low_limit && entry.high_limit)) signal.min = signal.max = "0";
  return signal;
}

[[nodiscard]] std::string bits_text(unsigned first, unsigned bits) {
  return bits == 1 ? fmt::format("bit {}", first) : fmt::format("bits {} to {}", first, first + bits - 1);
}

[[nodiscard]] DbcSignal signal_of(const BitField& field) {
  DbcSignal signal;
  signal.first_bit = field.first_bit;
  signal.bits = field.bits;
  signal.is_signed = field.is_signed;
  signal.name = "_" + field.name;
  if (field.values) signal.values = &*field.values;
  set_quantity(signal, field.quantity.value_or(Quantity{}), type_of(field), lowest_of(field.bits, field.is_signed),
               highest_of(field.bits, field.is_signed));
  signal.text = bits_text(field.first_bit, field.bits) + (field.text.empty() ? "" : ": " + field.text);
  return signal;
}

/// Bits without a field.
[[nodiscard]] DbcSignal signal_of_bits(unsigned first, unsigned bits) {
  DbcSignal signal;
  signal.first_bit = first;
  signal.bits = bits;
  signal.name = bits == 1 ? fmt::format("_bit_{}", first) : fmt::format("_bits_{}_to_{}", first, first + bits - 1);
  signal.max = fmt::format("{}", low_bits(bits));
  signal.text = bits_text(first, bits);
  return signal;
}

}  // namespace

std::vector<DbcSignal> dbc_signals(const Entry& entry, unsigned bits) {
  if (!entry.meaning || entry.meaning->fields.empty()) return {whole_entry(entry, bits)};
  std::vector<DbcSignal> signals;
  unsigned next = 0;
  for (const BitField& field : entry.meaning->fields) {
    const unsigned end = field.first_bit + field.bits;
    // Fields that overlap, or that are not in the mapped bits, have been reported.
    if (field.first_bit < next || end > bits) continue;
    if (field.first_bit > next) signals.push_back(signal_of_bits(next, field.first_bit - next));
    if (!field.is_reserved()) signals.push_back(signal_of(field));
    next = end;
  }
  if (next < bits) signals.push_back(signal_of_bits(next, bits - next));
  return signals;
}

}  // namespace edsc
