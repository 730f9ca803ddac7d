/// The server's side of the socketcand protocol as text: elements such as "< send 123 2 11 22 >", one frame each. The
/// client's side is canopen/host/socketcand_codec.hpp.
#pragma once

#include <fmt/format.h>

#include <canopen/can/frame.hpp>
#include <canopen/host/socketcand_codec.hpp>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "values/append.hpp"

namespace edsc::socketcand {

/// Bytes between "<" and ">". The longest element of the raw mode has about 60.
inline constexpr std::size_t longest_element = 200;

/// Seconds and microseconds since 1970, of a frame that was received.
struct TimeStamp {
  std::int64_t seconds = 0;
  std::int32_t microseconds = 0;  ///< 0..999 999
};

/// `23.000042`
inline void append_time(std::string& text, TimeStamp time) {
  fmt::format_to(std::back_inserter(text), "{}.{:06}", time.seconds, time.microseconds);
}

/// Reads bytes one by one and finds elements; text outside elements is ignored.
class ElementReader {
 public:
  enum class Found { nothing, element, too_long };

  /// Returns `element` at the ">" that ends one; `too_long` at the first byte above the limit: the rest of the element
  /// is ignored.
  [[nodiscard]] Found take(char c) {
    if (c == '<') {
      text_.clear();
      inside_ = true;
    } else if (inside_ && c == '>') {
      inside_ = false;
      return Found::element;
    } else if (inside_ && text_.size() == longest_element) {
      inside_ = false;
      return Found::too_long;
    } else if (inside_) {
      text_ += c;
    }
    return Found::nothing;
  }

  /// The text between "<" and ">" of the element that `take` has found; valid until the next call of `take`.
  [[nodiscard]] std::string_view element() const { return text_; }

 private:
  std::string text_;
  bool inside_ = false;
};

/// Returns the frame of a client's "send ID DLC BYTE..." or "sendrtr ID DLC"; nothing for any other element. A CAN-ID
/// has 29 bits if it has eight digits, or a value above 7FFh.
[[nodiscard]] inline std::optional<canopen::Frame> parse_send(std::string_view element) {
  using canopen::slcan::hex_number, canopen::socketcand::take_word;
  canopen::Frame frame;
  const std::string_view command = take_word(element);
  frame.remote = command == "sendrtr";
  if (command != "send" && !frame.remote) return std::nullopt;
  const std::string_view digits = take_word(element);
  const auto id = hex_number(digits), size = hex_number(take_word(element));
  if (!id || *id > 0x1FFF'FFFF || !size || *size > 8) return std::nullopt;
  frame.id = *id;
  frame.extended = digits.size() == 8 || *id > 0x7FF;
  frame.size = static_cast<std::uint8_t>(*size);
  for (std::size_t i = 0; !frame.remote && i < frame.size; ++i) {
    const std::string_view word = take_word(element);
    const auto byte = hex_number(word);
    if (!byte || word.size() > 2) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return take_word(element).empty() ? std::optional{frame} : std::nullopt;
}

/// What the server sends for a frame: "< frame 123 23.424242 1122 >" or "< rtr 123 23.424242 2 >".
[[nodiscard]] inline std::string received_text(const canopen::Frame& frame, TimeStamp time) {
  std::string text{frame.remote ? "< rtr " : "< frame "};
  append_can_id(text, frame);
  text += ' ';
  append_time(text, time);
  text += ' ';
  if (frame.remote) append_decimal(text, frame.size);
  append_hex_bytes(text, data_of(frame), "");
  return text + " >";
}

}  // namespace edsc::socketcand
