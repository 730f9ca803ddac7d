/// Copies values of 1..64 bits to and from any bit position of a PDO whose layout is known only at run time: a mapping
/// that was changed over the bus (CiA 301, 7.5.2.36). Least significant bit first.
///
/// Uses 32-bit words and single bytes: small controllers do not have 64-bit shifts or unaligned loads.
#pragma once

#include <cstdint>

namespace canopen {

/// Writes the low `bits` bits (0..64) of `value` at bit `at` of `data`. The other bits of `data` do not change.
constexpr void put_bits(std::uint8_t* data, unsigned at, unsigned bits, std::uint64_t value) {
  auto low = static_cast<std::uint32_t>(value);
  auto high = static_cast<std::uint32_t>(value >> 32);
  const unsigned end = at + bits;
  while (at < end) {
    const unsigned next_byte = (at | 7u) + 1;
    const unsigned count = (next_byte < end ? next_byte : end) - at;  // 1..8
    const unsigned shift = at % 8;
    const std::uint32_t mask = ((1u << count) - 1) << shift;
    data[at / 8] = static_cast<std::uint8_t>((data[at / 8] & ~mask) | ((low << shift) & mask));
    low = (low >> count) | (high << (32 - count));
    high >>= count;
    at += count;
  }
}

/// Returns `bits` bits (0..64) of `data`, starting at bit `at`.
[[nodiscard]] constexpr std::uint64_t take_bits(const std::uint8_t* data, unsigned at, unsigned bits) {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  unsigned end = at + bits;
  while (at < end) {
    const unsigned this_byte = (end - 1) & ~7u;
    const unsigned first = this_byte > at ? this_byte : at;
    const unsigned count = end - first;  // 1..8
    high = (high << count) | (low >> (32 - count));
    low = (low << count) | ((static_cast<std::uint32_t>(data[first / 8]) >> (first % 8)) & ((1u << count) - 1));
    end = first;
  }
  return (std::uint64_t{high} << 32) | low;
}

}  // namespace canopen
