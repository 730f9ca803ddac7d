/// CRC of an SDO block transfer: x^16 + x^12 + x^5 + 1, start value 0, high bit first (CiA 301, 7.2.4.3.16).
#pragma once

#include <cstdint>

namespace canopen {

/// The CRC of some bytes and one more. No table: a byte takes a few shifts and exclusive ors.
[[nodiscard]] constexpr std::uint16_t crc16(std::uint16_t crc, std::uint8_t byte) {
  std::uint32_t high = (std::uint32_t{crc} >> 8) ^ byte;
  high ^= high >> 4;
  return static_cast<std::uint16_t>((std::uint32_t{crc} << 8) ^ (high << 12) ^ (high << 5) ^ high);
}

}  // namespace canopen
