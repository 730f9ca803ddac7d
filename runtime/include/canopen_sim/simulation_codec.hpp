/// The protocol, version 1, between `edsc` and the program of a simulated device: lines of text with words separated by
/// one blank. CAN-IDs, indices, codes and bytes are hexadecimal, all else decimal. The program begins with
/// `edsc-simulation 1`. It obeys
///
///     node NODE-ID [NAME]          a new bus of 1 Mbit/s, a new node with empty storage, power-on at time 0
///     send CAN-ID[X] [BYTES]       another participant sends a data frame; X: 29 bits
///     send CAN-ID[X]R LENGTH       the same with a remote frame
///     run MICROSECONDS             lets this time pass, at most until the device has sent a frame. The answer is the
///     time since
///                                  `node` in us, and the frame: `TIME` or `TIME CAN-ID[X] [BYTES]` or `TIME CAN-ID[X]R
///                                  LENGTH`
///     set INDEX SUB BYTES          the application sets an object, bytes as SDO sends them
///     emergency CODE REGISTER      the application reports an error with these bits of 1001h
///     emergency_over REGISTER      the error has gone
///     power_cycle                  off and on; storage is kept
///
/// `send` does not have an answer. That of `node` is `no` from a program that does not have this device, else `ok` and
/// the composition of the device, each word after a blank: `composition=edsc` without an application, `without=lss`,
/// `without=storage` and `without=INDEX:SUB` (a DOMAIN) for each part that it omits although its EDS promises it. The
/// last four answer `ok`, `refused ABORT-CODE`, or `no` from a program that cannot do it, and let no time pass. The
/// program ends with its input, with exit code 0, or with 2 at a line that is not one of these.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "canopen/can/frame.hpp"
#include "canopen/port/slcan_codec.hpp"

namespace canopen::simulation {

inline constexpr std::string_view greeting = "edsc-simulation 1";

/// Takes the next word off the front of a line; an empty one at its end.
[[nodiscard]] constexpr std::string_view take_word(std::string_view& line) {
  const std::size_t blank = line.find(' ');
  const std::string_view word = line.substr(0, blank);
  line = blank == std::string_view::npos ? std::string_view{} : line.substr(blank + 1);
  return word;
}

/// A number of 0..max; nothing for any other text.
template <class Type>
[[nodiscard]] std::optional<Type> number(std::string_view text, int base, Type max) {
  Type value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, base);
  return error == std::errc{} && end == last && value <= max ? std::optional{value} : std::nullopt;
}

inline void append_bytes(std::string& line, std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) {
    char digits[2];
    slcan::put_hex(digits, byte, 2);
    line.append(digits, 2);
  }
}

/// Bytes of two digits each; nothing for any other text.
[[nodiscard]] inline std::optional<std::vector<std::uint8_t>> parse_bytes(std::string_view digits) {
  std::vector<std::uint8_t> bytes;
  if (digits.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const auto byte = number<std::uint8_t>(digits.substr(i, 2), 16, 0xFF);
    if (!byte) return std::nullopt;
    bytes.push_back(*byte);
  }
  return bytes;
}

/// `CAN-ID[X] [BYTES]` or `CAN-ID[X]R LENGTH`
inline void append_frame(std::string& line, const Frame& frame) {
  char digits[8];
  char* const end = slcan::put_hex(digits, frame.id, frame.extended ? 8 : 3);
  line.append(digits, end);
  if (frame.extended) line += 'X';
  if (frame.remote) {
    line += "R ";
    line += static_cast<char>('0' + frame.size);
    return;
  }
  if (frame.size != 0) line += ' ';
  append_bytes(line, std::span{frame.data}.first(frame.size));
}

[[nodiscard]] inline std::optional<Frame> parse_frame(std::string_view text) {
  Frame frame;
  std::string_view id = take_word(text);
  if (id.ends_with('R')) {
    frame.remote = true;
    id.remove_suffix(1);
  }
  if (id.ends_with('X')) {
    frame.extended = true;
    id.remove_suffix(1);
  }
  const auto can_id = number<std::uint32_t>(id, 16, frame.extended ? 0x1FFF'FFFF : 0x7FF);
  if (!can_id) return std::nullopt;
  frame.id = *can_id;
  if (frame.remote) {
    const auto length = number<std::uint8_t>(text, 10, 8);
    frame.size = length.value_or(0);
    return length ? std::optional{frame} : std::nullopt;
  }
  const auto bytes = parse_bytes(text);
  if (!bytes || bytes->size() > frame.data.size()) return std::nullopt;
  for (const std::uint8_t byte : *bytes) frame.data[frame.size++] = byte;
  return frame;
}

}  // namespace canopen::simulation
