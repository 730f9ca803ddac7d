/// The server's side of the socketcand protocol as text: elements such as "< send 123 2 11 22 >", one frame each. The
/// client's side is canopen/host/socketcand_codec.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/can/frame.hpp"

namespace edsc::socketcand {

/// Bytes between "<" and ">". The longest element of the raw mode has about 60.
inline constexpr std::size_t longest_element = 200;

/// Seconds and microseconds since 1970, of a frame that was received.
struct TimeStamp {
  std::int64_t seconds = 0;
  std::int32_t microseconds = 0;  ///< 0..999 999
};

/// Reads bytes one by one and finds elements; text outside elements is ignored.
class ElementReader {
 public:
  enum class Found { nothing, element, too_long };

  /// Returns `element` at the ">" that ends one; `too_long` at the first byte above the limit: the rest of the element
  /// is ignored.
  [[nodiscard]] Found take(char c) {
    if (c == '<') {
      size_ = 0;
      inside_ = true;
      return Found::nothing;
    }
    if (!inside_) return Found::nothing;
    if (c == '>') {
      inside_ = false;
      return Found::element;
    }
    if (size_ == text_.size()) {
      inside_ = false;
      return Found::too_long;
    }
    text_[size_++] = c;
    return Found::nothing;
  }

  /// The text between "<" and ">" of the element that `take` has found; valid until the next call of `take`.
  [[nodiscard]] std::string_view element() const { return {text_.data(), size_}; }

 private:
  std::array<char, longest_element> text_{};
  std::size_t size_ = 0;
  bool inside_ = false;
};

/// Reads the words of an element, separated by blanks, one after the other.
class Words {
 public:
  explicit constexpr Words(std::string_view element) : rest_{element} {}

  /// Returns the next word; empty at the end.
  [[nodiscard]] constexpr std::string_view next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(word.size());
    return word;
  }

  [[nodiscard]] constexpr bool at_end() const { return rest_.find_first_not_of(' ') == std::string_view::npos; }

 private:
  std::string_view rest_;
};

namespace detail {

/// Reads a whole word as a number up to `max`.
[[nodiscard]] inline std::optional<std::uint32_t> number(std::string_view word, int base, std::uint32_t max) {
  std::uint32_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value, base);
  if (error != std::errc{} || stop != end || value > max) return std::nullopt;
  return value;
}

/// A CAN-ID has 29 bits if it has eight digits, or a value above 7FFh.
[[nodiscard]] inline bool read_id(std::string_view word, canopen::Frame& frame) {
  const auto id = number(word, 16, 0x1FFF'FFFF);
  if (!id || word.size() > 8) return false;
  frame.id = *id;
  frame.extended = word.size() == 8 || *id > 0x7FF;
  return true;
}

[[nodiscard]] inline bool read_size(std::string_view word, canopen::Frame& frame) {
  const auto size = number(word, 10, 8);
  frame.size = static_cast<std::uint8_t>(size.value_or(0));
  return size.has_value();
}

}  // namespace detail

/// Returns the frame of a client's "send ID DLC BYTE..." or "sendrtr ID DLC"; nothing for any other element.
[[nodiscard]] inline std::optional<canopen::Frame> parse_send(std::string_view element) {
  Words words{element};
  const std::string_view command = words.next();
  canopen::Frame frame;
  frame.remote = command == "sendrtr";
  if (command != "send" && !frame.remote) return std::nullopt;
  if (!detail::read_id(words.next(), frame) || !detail::read_size(words.next(), frame)) return std::nullopt;
  for (std::size_t i = 0; !frame.remote && i < frame.size; ++i) {
    const std::string_view word = words.next();
    const auto byte = detail::number(word, 16, 0xFF);
    if (!byte || word.size() > 2) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return words.at_end() ? std::optional{frame} : std::nullopt;
}

/// The text of one frame, in place.
class ElementText {
 public:
  [[nodiscard]] std::string_view view() const { return {text_.data(), size_}; }

  void add(std::string_view part) {
    for (const char c : part) add(c);
  }
  void add(char c) {
    if (size_ < text_.size()) text_[size_++] = c;
  }
  void add_hex(std::uint32_t value, unsigned digits) {
    while (digits-- > 0) add("0123456789ABCDEF"[value >> (4 * digits) & 0xF]);
  }
  void add_id(const canopen::Frame& frame) { add_hex(frame.id, frame.extended ? 8 : 3); }
  void add_time(TimeStamp time) {
    const auto end = std::to_chars(text_.data() + size_, text_.data() + text_.size(), time.seconds).ptr;
    size_ = static_cast<std::size_t>(end - text_.data());
    add('.');
    for (std::int32_t unit = 100'000; unit > 0; unit /= 10) add(static_cast<char>('0' + time.microseconds / unit % 10));
  }

 private:
  std::array<char, 80> text_{};
  std::size_t size_ = 0;
};

/// What the server sends for a frame: "< frame 123 23.424242 1122 >" or "< rtr 123 23.424242 2 >".
[[nodiscard]] inline ElementText received_text(const canopen::Frame& frame, TimeStamp time) {
  ElementText text;
  text.add(frame.remote ? "< rtr " : "< frame ");
  text.add_id(frame);
  text.add(' ');
  text.add_time(time);
  text.add(' ');
  if (frame.remote) text.add_hex(frame.size, 1);
  for (std::size_t i = 0; !frame.remote && i < frame.size; ++i) text.add_hex(frame.data[i], 2);
  text.add(" >");
  return text;
}

}  // namespace edsc::socketcand
