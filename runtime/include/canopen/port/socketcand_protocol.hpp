/// The socketcand protocol as text: elements such as "< send 123 2 11 22 >", one frame each. Client and server share
/// it.
///
/// Remote frames: "< sendrtr ID DLC >" from a client, "< rtr ID SECONDS.MICROSECONDS DLC >" to it, as the protocol's
/// description has them; programs that do not know them pass them over.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/frame.hpp"

namespace canopen::socketcand {

/// Bytes between "<" and ">". The longest element of the raw mode has some 60.
inline constexpr std::size_t longest_element = 200;

/// Seconds and microseconds since 1970, of a frame that was received.
struct TimeStamp {
  std::int64_t seconds = 0;
  std::int32_t microseconds = 0;  ///< 0..999 999
};

/// Takes bytes one by one and finds elements in them; what stands outside of them is passed over.
class ElementReader {
 public:
  enum class Found { nothing, element, too_long };

  /// `element` with the ">" that ends one; `too_long` with the byte that is one too many: the rest of it is passed
  /// over.
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

  /// What stands between "<" and ">" of the element that `take` has found; valid until the next call of `take`.
  [[nodiscard]] std::string_view element() const { return {text_.data(), size_}; }

 private:
  std::array<char, longest_element> text_{};
  std::size_t size_ = 0;
  bool inside_ = false;
};

/// Takes the words of an element, which blanks part, one after the other.
class Words {
 public:
  explicit constexpr Words(std::string_view element) : rest_{element} {}

  /// The next word; empty when there is none.
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

/// A whole word as a number of at most `max`.
[[nodiscard]] inline std::optional<std::uint32_t> number(std::string_view word, int base, std::uint32_t max) {
  std::uint32_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value, base);
  if (error != std::errc{} || stop != end || value > max) return std::nullopt;
  return value;
}

/// Eight digits make a CAN-ID of 29 bits; so does a value that 11 bits do not hold.
[[nodiscard]] inline bool read_id(std::string_view word, Frame& frame) {
  const auto id = number(word, 16, 0x1FFF'FFFF);
  if (!id || word.size() > 8) return false;
  frame.id = *id;
  frame.extended = word.size() == 8 || *id > 0x7FF;
  return true;
}

[[nodiscard]] inline bool read_size(std::string_view word, Frame& frame) {
  const auto size = number(word, 10, 8);
  frame.size = static_cast<std::uint8_t>(size.value_or(0));
  return size.has_value();
}

[[nodiscard]] inline bool read_time(std::string_view word) {
  const std::size_t point = word.find('.');
  const auto digits = [](std::string_view part) {
    return !part.empty() && part.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return digits(word.substr(0, point)) && (point == std::string_view::npos || digits(word.substr(point + 1)));
}

/// The data of a received frame: two digits a byte, with or without blanks between the bytes.
[[nodiscard]] inline bool read_received_data(Words& words, Frame& frame) {
  while (!words.at_end()) {
    std::string_view word = words.next();
    if (word.size() % 2 != 0) return false;
    for (; !word.empty(); word.remove_prefix(2)) {
      const auto byte = number(word.substr(0, 2), 16, 0xFF);
      if (!byte || frame.size == frame.data.size()) return false;
      frame.data[frame.size++] = static_cast<std::uint8_t>(*byte);
    }
  }
  return true;
}

}  // namespace detail

/// The frame of a client's "send ID DLC BYTE..." or "sendrtr ID DLC"; nothing when the element is no such one.
[[nodiscard]] inline std::optional<Frame> parse_send(std::string_view element) {
  Words words{element};
  const std::string_view command = words.next();
  Frame frame;
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

/// The frame of a server's "frame ID TIME DATA" or "rtr ID TIME DLC"; nothing when the element is no such one.
[[nodiscard]] inline std::optional<Frame> parse_received(std::string_view element) {
  Words words{element};
  const std::string_view kind = words.next();
  Frame frame;
  frame.remote = kind == "rtr";
  if (kind != "frame" && !frame.remote) return std::nullopt;
  if (!detail::read_id(words.next(), frame) || !detail::read_time(words.next())) return std::nullopt;
  const bool read = frame.remote ? detail::read_size(words.next(), frame) : detail::read_received_data(words, frame);
  return read && words.at_end() ? std::optional{frame} : std::nullopt;
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
  void add_id(const Frame& frame) { add_hex(frame.id, frame.extended ? 8 : 3); }
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

/// What a client sends for a frame: "< send 123 2 11 22 >" or "< sendrtr 123 2 >".
[[nodiscard]] inline ElementText send_text(const Frame& frame) {
  ElementText text;
  text.add(frame.remote ? "< sendrtr " : "< send ");
  text.add_id(frame);
  text.add(' ');
  text.add_hex(frame.size, 1);
  for (std::size_t i = 0; !frame.remote && i < frame.size; ++i) {
    text.add(' ');
    text.add_hex(frame.data[i], 2);
  }
  text.add(" >");
  return text;
}

/// What a server sends for a frame: "< frame 123 23.424242 1122 >" or "< rtr 123 23.424242 2 >".
[[nodiscard]] inline ElementText received_text(const Frame& frame, TimeStamp time) {
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

}  // namespace canopen::socketcand
