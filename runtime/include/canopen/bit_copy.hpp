/// Values of 1..64 bits at any bit of a PDO, where place and length are known at run time only: a mapping that was
/// changed over the bus (CiA 301, 7.5.2.36). Low bit first.
///
/// In words of 32 bits and byte by byte: small controllers have neither shifts of 64 bits nor unaligned loads.
#pragma once

#include <cstdint>

namespace canopen {

/// Puts the low `bits` bits (0..64) of `value` at bit `at` of `data`. The other bits of `data` stay.
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

/// The `bits` bits (0..64) from bit `at` of `data` on.
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
