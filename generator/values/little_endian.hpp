/// Numbers in the bytes of SDOs and PDOs, low byte first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edsc {

/// The number in these bytes; bytes after the eighth are ignored.
[[nodiscard]] constexpr std::uint64_t number_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t number = 0;
  for (std::size_t i = std::min<std::size_t>(bytes.size(), 8); i-- > 0;) number = number << 8 | bytes[i];
  return number;
}

[[nodiscard]] inline std::vector<std::uint8_t> bytes_of(std::uint64_t number, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < std::min<std::size_t>(size, 8); ++i) {
    bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return bytes;
}

/// A number with the lowest `bits` bits set; all 64 from 64 on.
[[nodiscard]] constexpr std::uint64_t low_bits(unsigned bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

/// The number in two's complement of 1 to 64 bits.
[[nodiscard]] constexpr std::int64_t sign_extended(std::uint64_t number, unsigned bits) {
  const unsigned unused = 64 - bits;
  return static_cast<std::int64_t>(number << unused) >> unused;
}

/// The whole bytes that hold this many bits.
[[nodiscard]] constexpr std::size_t bytes_for(std::size_t bits) { return (bits + 7) / 8; }

}  // namespace edsc
