/// Appends numbers and frames to a text without a format string: a log of a million frames has ten million of them.
#pragma once

#include <fmt/format.h>

#include <canopen/base/abort_code.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace edsc {

template <class Integer>
void append_decimal(std::string& text, Integer number) {
  const fmt::format_int digits{number};
  text.append(digits.data(), digits.size());
}

/// The given number of upper-case digits; higher digits are truncated.
inline void append_hex(std::string& text, std::uint64_t number, unsigned digits) {
  char buffer[16];
  for (unsigned i = digits; i-- > 0; number >>= 4) buffer[i] = "0123456789ABCDEF"[number & 0xF];
  text.append(buffer, digits);
}

/// `0A 1B`
inline void append_hex_bytes(std::string& text, std::span<const std::uint8_t> bytes, std::string_view separator = " ") {
  std::string_view before;
  for (const std::uint8_t byte : bytes) {
    text += before;
    append_hex(text, byte, 2);
    before = separator;
  }
}
[[nodiscard]] inline std::string hex_bytes(std::span<const std::uint8_t> bytes) {
  std::string text;
  append_hex_bytes(text, bytes);
  return text;
}

/// `0237h`
inline void append_hex_number(std::string& text, std::uint64_t number, unsigned digits) {
  append_hex(text, number, digits);
  text += 'h';
}

/// `6064h:00`
inline void append_entry_label(std::string& text, std::uint16_t index, std::uint8_t sub_index) {
  append_hex_number(text, index, 4);
  text += ':';
  append_hex(text, sub_index, 2);
}

/// `0602 0000h object does not exist`
inline void append_abort(std::string& text, std::uint32_t code, std::string_view separator = " ") {
  append_hex(text, code >> 16, 4);
  text += ' ';
  append_hex_number(text, code, 4);
  text.append(separator).append(canopen::to_text(canopen::abort_code_from(code)));
}

/// `181`; eight digits for an extended CAN-ID.
inline void append_can_id(std::string& text, const canopen::Frame& frame) {
  append_hex(text, frame.id, frame.extended ? 8 : 3);
}

/// The data bytes of a frame; a remote frame has none.
[[nodiscard]] inline std::span<const std::uint8_t> data_of(const canopen::Frame& frame) {
  return std::span{frame.data}.first(frame.remote ? 0 : frame.size);
}

}  // namespace edsc
