/// Values as bytes of an SDO or PDO, low byte first, and as bits of a number.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "device/device.hpp"

namespace edsc {

/// A number with the lowest `bits` bits set; all 64 from 64 on.
[[nodiscard]] constexpr std::uint64_t low_bits(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// The number whose two's complement has `bits` bits, 1 to 64.
[[nodiscard]] constexpr std::int64_t sign_extended(std::uint64_t number, unsigned bits) {
  return static_cast<std::int64_t>(number << (64U - bits)) >> (64U - bits);
}

/// The number of at most eight bytes.
[[nodiscard]] std::uint64_t number_from(std::span<const std::uint8_t> bytes);

/// Appends a number with this many bytes to `bytes`.
void append_bytes(std::string& bytes, std::uint64_t number, unsigned count);

/// A value as SDO download data; a UNICODE_STRING in UTF-16.
[[nodiscard]] std::string bytes_of(const Value& value, const canopen::DataTypeRow& type);

/// Bytes as pairs of hexadecimal digits.
[[nodiscard]] std::string hex_pairs(std::string_view bytes);

/// The bits of a REAL32 or REAL64 as a number; exact, since a double holds each float.
[[nodiscard]] double real_of(std::uint64_t bits, const canopen::DataTypeRow& type);

/// The bits of a REAL32 or REAL64 as the shortest decimal number that has them.
[[nodiscard]] std::string real_text(std::uint64_t bits, const canopen::DataTypeRow& type);

}  // namespace edsc
