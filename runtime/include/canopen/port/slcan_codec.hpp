/// SLCAN, the ASCII protocol of the Lawicel adapters: CAN frames as lines on a serial line. The text, for hosts and
/// targets: no operating system, no heap. slcan_adapter.hpp and slcan_host.hpp have the two sides.
///
///   t12320011[CR]          data frame 123h, 2 bytes 00 11        r1232[CR]       remote frame
///   T123456782AABB[CR]     the same with 29 bits                 R123456782[CR]
///
/// Commands to the adapter: S0..S8 bit rate, sxxyy bit timing registers, O open, L open to listen only, C close,
/// Mxxxxxxxx and mxxxxxxxx acceptance code and mask, Z0 and Z1 time stamps, F status flags, V version, N serial number.
/// The adapter responds with [CR], or with [BEL] to a command that it rejects.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "canopen/can/frame.hpp"

namespace canopen {

namespace slcan {

inline constexpr char end = '\r';
inline constexpr char refusal = '\a';

/// Characters of the longest frame: letter, identifier, length, data, time stamp and end of line.
inline constexpr std::size_t longest_line = 1 + 8 + 1 + 16 + 4 + 1;

/// Bit rates of the commands S0..S8, in bit/s.
inline constexpr std::uint32_t bit_rates[] = {10'000,  20'000,  50'000,  100'000,  125'000,
                                              250'000, 500'000, 800'000, 1'000'000};

/// Returns the digit of the command S for a bit rate; empty if there is none.
[[nodiscard]] constexpr std::optional<std::uint8_t> bit_rate_code(std::uint32_t bit_rate) {
  for (std::size_t i = 0; i < std::size(bit_rates); ++i) {
    if (bit_rates[i] == bit_rate) return static_cast<std::uint8_t>(i);
  }
  return std::nullopt;
}

/// Status flags of the command F.
namespace flag {
inline constexpr std::uint8_t receive_queue_full = 0x01;
inline constexpr std::uint8_t send_queue_full = 0x02;
inline constexpr std::uint8_t error_warning = 0x04;
inline constexpr std::uint8_t data_overrun = 0x08;
inline constexpr std::uint8_t error_passive = 0x20;
inline constexpr std::uint8_t arbitration_lost = 0x40;
inline constexpr std::uint8_t bus_error = 0x80;
}  // namespace flag

/// Returns the value of a hexadecimal digit; 16 for any other character.
[[nodiscard]] constexpr std::uint8_t hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return static_cast<std::uint8_t>(digit - '0');
  if (digit >= 'A' && digit <= 'F') return static_cast<std::uint8_t>(digit - 'A' + 10);
  if (digit >= 'a' && digit <= 'f') return static_cast<std::uint8_t>(digit - 'a' + 10);
  return 16;
}

/// Returns a number of up to eight hexadecimal digits; empty if one of them is not a digit.
[[nodiscard]] constexpr std::optional<std::uint32_t> hex_number(std::string_view digits) {
  std::uint32_t number = 0;
  for (const char digit : digits) {
    const std::uint8_t value = hex_value(digit);
    if (value > 15) return std::nullopt;
    number = (number << 4) | value;
  }
  return digits.empty() || digits.size() > 8 ? std::nullopt : std::optional{number};
}

/// Writes a number with this many hexadecimal digits; returns the position after them.
constexpr char* put_hex(char* to, std::uint32_t number, unsigned digits) {
  for (unsigned i = digits; i-- > 0; ++to) *to = "0123456789ABCDEF"[(number >> (4 * i)) & 0xF];
  return to;
}

/// Writes the line of a frame, including its end, and returns its length. With a time stamp in ms, if given.
[[nodiscard]] constexpr std::size_t encode(const Frame& frame, std::span<char, longest_line> line,
                                           std::optional<std::uint16_t> milliseconds = std::nullopt) {
  char* to = line.data();
  if (frame.remote) {
    *to++ = frame.extended ? 'R' : 'r';
  } else {
    *to++ = frame.extended ? 'T' : 't';
  }
  to = put_hex(to, frame.id, frame.extended ? 8 : 3);
  to = put_hex(to, frame.size, 1);
  for (std::uint8_t i = 0; i < frame.size && !frame.remote; ++i) to = put_hex(to, frame.data[i], 2);
  if (milliseconds) to = put_hex(to, *milliseconds, 4);
  *to++ = end;
  return static_cast<std::size_t>(to - line.data());
}

/// Returns the frame of a line without its end; empty if it is not one. A time stamp after it is ignored.
[[nodiscard]] constexpr std::optional<Frame> decode(std::string_view line) {
  if (line.empty()) return std::nullopt;
  Frame frame{};
  switch (line[0]) {
    case 't': break;
    case 'r': frame.remote = true; break;
    case 'T': frame.extended = true; break;
    case 'R': frame.extended = frame.remote = true; break;
    default: return std::nullopt;
  }
  const std::size_t digits = frame.extended ? 8 : 3;
  if (line.size() < 1 + digits + 1) return std::nullopt;
  const std::optional<std::uint32_t> id = hex_number({line.data() + 1, digits});
  const std::uint8_t size = hex_value(line[1 + digits]);
  if (!id || *id > (frame.extended ? 0x1FFF'FFFFu : 0x7FFu) || size > 8) return std::nullopt;
  frame.id = *id;
  frame.size = size;
  line.remove_prefix(1 + digits + 1);
  for (std::uint8_t i = 0; i < size && !frame.remote; ++i) {
    const std::optional<std::uint32_t> byte = line.size() >= 2 ? hex_number({line.data(), 2}) : std::nullopt;
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
    line.remove_prefix(2);
  }
  const bool time_stamp = line.size() == 4 && hex_number(line).has_value();
  return line.empty() || time_stamp ? std::optional{frame} : std::nullopt;
}

/// Assembles characters to lines. Characters that are not letters or digits discard what precedes them; of a line that
/// is longer than any frame, the beginning is kept, which is not a valid frame.
class LineReader {
 public:
  /// Returns the line that this character ends, without it; valid until the next call. A [BEL] is a line of its own.
  [[nodiscard]] std::optional<std::string_view> take(char character) {
    if (character == end || character == refusal) {
      const std::string_view line{text_.data(), size_};
      size_ = 0;
      if (character == end) return line;
      return std::string_view{&refusal, 1};
    }
    const char letter = static_cast<char>(character | 0x20);
    const bool known = (character >= '0' && character <= '9') || (letter >= 'a' && letter <= 'z');
    if (!known) {
      size_ = 0;
    } else if (size_ < text_.size()) {
      text_[size_++] = character;
    }
    return std::nullopt;
  }

 private:
  std::array<char, longest_line> text_{};
  std::uint8_t size_ = 0;
};

}  // namespace slcan

/// The channel settings of a host.
struct SlcanChannel {
  enum class Rate : std::uint8_t { unspecified, code, registers };

  Rate rate = Rate::unspecified;
  std::uint16_t value =
      0;  ///< of `code` 0..8, see slcan::bit_rates; of `registers` BTR0 in the high and BTR1 in the low byte
  bool listen_only = false;

  friend constexpr bool operator==(const SlcanChannel&, const SlcanChannel&) = default;
};

}  // namespace canopen
