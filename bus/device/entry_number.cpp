#include "device/entry_number.hpp"

#include <algorithm>
#include <bit>
#include <canopen/od/data_type.hpp>
#include <cmath>

#include "values/little_endian.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;

constexpr unsigned bits_of_real32 = 32;

/// The bits of an integer of this type.
std::uint64_t integer_bits(const canopen::DataTypeRow& type, double number, OutOfRange out_of_range) {
  const bool is_signed = type.kind == DataClass::signed_integer;
  const double size = std::ldexp(1.0, type.bits);
  double rounded = std::isnan(number) ? 0.0 : std::nearbyint(number);
  if (out_of_range == OutOfRange::wraps) {
    rounded = std::fmod(rounded, size);
    if (rounded < 0) rounded += size;
    return static_cast<std::uint64_t>(rounded);
  }
  const double lowest = is_signed ? -size / 2 : 0.0, above = is_signed ? size / 2 : size;
  if (rounded >= above) return low_bits(is_signed ? type.bits - 1U : type.bits);
  rounded = std::max(rounded, lowest);
  return is_signed ? static_cast<std::uint64_t>(static_cast<std::int64_t>(rounded))
                   : static_cast<std::uint64_t>(rounded);
}

}  // namespace

bool has_number(const Entry& entry) {
  const DataClass kind = entry.type->kind;
  return kind == DataClass::boolean || kind == DataClass::unsigned_integer || kind == DataClass::signed_integer ||
         kind == DataClass::real;
}

std::optional<double> entry_number(const Entry& entry, std::span<const std::uint8_t> bytes) {
  if (!has_number(entry) || bytes.empty()) return std::nullopt;
  const std::uint64_t bits = number_of(bytes);
  switch (entry.type->kind) {
    case DataClass::real: return real_of(bits, *entry.type);
    case DataClass::signed_integer: return static_cast<double>(sign_extended(bits, entry.type->bits));
    default: return static_cast<double>(bits);
  }
}

std::vector<std::uint8_t> entry_bytes(const Entry& entry, double number, OutOfRange out_of_range) {
  if (!has_number(entry)) return {};
  const canopen::DataTypeRow& type = *entry.type;
  const std::size_t size = bytes_for(type.bits);
  if (type.kind == DataClass::boolean) return {static_cast<std::uint8_t>(number != 0.0 ? 1 : 0)};
  if (type.kind != DataClass::real) return bytes_of(integer_bits(type, number, out_of_range), size);
  if (type.bits == bits_of_real32) return bytes_of(std::bit_cast<std::uint32_t>(static_cast<float>(number)), size);
  return bytes_of(std::bit_cast<std::uint64_t>(number), size);
}

std::uint64_t bits_of_integer(double number) {
  constexpr double end = 18'446'744'073'709'551'616.0;  // 2^64
  if (number >= 0 && number < end) return static_cast<std::uint64_t>(number);
  if (number < 0 && number >= -end / 2) return static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
  return 0;
}

}  // namespace edsc
