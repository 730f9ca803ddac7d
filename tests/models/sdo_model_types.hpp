/// Entries, frames, abort codes and the CRC of the model of an SDO server.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

namespace model {

using Octets = std::vector<std::uint8_t>;
/// The eight data bytes of an SDO frame.
using Data = std::array<std::uint8_t, 8>;
using Answers = std::span<const Data>;

enum class Type { boolean, unsigned_integer, signed_integer, real32, string, domain };

struct Entry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  Type type{};
  bool readable = false;
  bool writable = false;
  std::size_t size = 0;  ///< bytes; maximum of a string or DOMAIN
  std::optional<double> low{};
  std::optional<double> high{};
  Octets value{};

  [[nodiscard]] bool variable() const { return type == Type::string || type == Type::domain; }
};

/// The abort codes of table 22.
using Code = std::uint32_t;
constexpr Code toggle_bit = 0x0503'0000;
constexpr Code timeout = 0x0504'0000;
constexpr Code command_specifier = 0x0504'0001;
constexpr Code block_size = 0x0504'0002;
constexpr Code sequence_number = 0x0504'0003;
constexpr Code crc_error = 0x0504'0004;
constexpr Code write_only = 0x0601'0001;
constexpr Code read_only = 0x0601'0002;
constexpr Code no_object = 0x0602'0000;
constexpr Code length_mismatch = 0x0607'0010;
constexpr Code too_long = 0x0607'0012;
constexpr Code too_short = 0x0607'0013;
constexpr Code no_sub_index = 0x0609'0011;
constexpr Code invalid_value = 0x0609'0030;
constexpr Code value_too_high = 0x0609'0031;
constexpr Code value_too_low = 0x0609'0032;
constexpr Code no_data = 0x0800'0024;

using Codes = std::initializer_list<Code>;

/// CRC of 7.2.4.3.16: x^16 + x^12 + x^5 + 1, initial value 0, bit by bit.
inline std::uint16_t crc_of(const Octets& bytes) {
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool carry = ((crc >> 15 & 1u) ^ (byte >> bit & 1u)) != 0;
      crc = (crc << 1 & 0xFFFF) ^ (carry ? 0x1021u : 0u);
    }
  }
  return static_cast<std::uint16_t>(crc);
}

}  // namespace model
