/// CRC-16-CCITT: x^16 + x^12 + x^5 + 1, most significant bit first. SDO block transfer starts with 0 (CiA 301,
/// 7.2.4.3.16).
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/optimization.hpp"

namespace canopen {

/// Returns the CRC after one more byte. Without a table: a byte takes a few shifts and exclusive ORs.
[[nodiscard]] constexpr std::uint16_t crc16_ccitt(std::uint16_t crc, std::uint8_t byte) {
  std::uint32_t high = (std::uint32_t{crc} >> 8) ^ byte;
  high ^= high >> 4;
  return static_cast<std::uint16_t>((std::uint32_t{crc} << 8) ^ (high << 12) ^ (high << 5) ^ high);
}

/// Returns the CRC after two more bytes; hardly slower than one.
[[nodiscard]] constexpr std::uint16_t crc16_ccitt(std::uint16_t crc, std::uint8_t first, std::uint8_t second) {
  const std::uint32_t word = crc ^ (static_cast<std::uint32_t>(first << 8) | second);
  std::uint32_t quotient = word ^ (word >> 4);
  quotient ^= quotient >> 8;
  quotient ^= word >> 11;
  return static_cast<std::uint16_t>(quotient ^ (quotient << 5) ^ (quotient << 12));
}

/// Returns the CRC after any number of bytes. Two at a time would take 48 bytes of a Cortex-M0+.
[[nodiscard]] constexpr std::uint16_t crc16_ccitt(std::uint16_t crc, std::span<const std::uint8_t> bytes) {
  const std::uint8_t* at = bytes.data();
  const std::uint8_t* const end = at + bytes.size();
  if constexpr (!prefers_size) {
    for (; end - at >= 2; at += 2) crc = crc16_ccitt(crc, at[0], at[1]);
  }
  for (; at != end; ++at) crc = crc16_ccitt(crc, *at);
  return crc;
}

}  // namespace canopen
