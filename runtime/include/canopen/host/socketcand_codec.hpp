/// The client's side of socketcand, the ASCII protocol that makes a CAN bus available to other machines, in raw mode:
/// no operating system, no heap.
///
///     server                                client
///     < hi >                                < open can0 >
///     < ok >                                < rawmode >
///     < ok >
///     < frame 123 23.424242 11223344 >      < send 123 2 11 22 >
///     < rtr 123 23.424242 4 >               < sendrtr 123 4 >
///     < error 040 23.424242 >
///
/// An identifier of eight digits has 29 bits. Remote frames and error frames are later additions: a server that does
/// not support them does not send any, and responds to `sendrtr` with `< error unknown command >`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/port/slcan_codec.hpp"

namespace canopen {

namespace socketcand {

/// Characters of the longest message of a client.
inline constexpr std::size_t longest_message = sizeof "< send 1FFFFFFF 8 00 11 22 33 44 55 66 77 >" - 1;

/// Removes the next word from the front of a message and returns it; empty at the end.
[[nodiscard]] constexpr std::string_view take_word(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  std::size_t size = 0;
  while (size < text.size() && text[size] != ' ') ++size;
  const std::string_view word = text.substr(0, size);
  text.remove_prefix(size);
  return word;
}

/// Writes a message that makes the server send a frame, and returns its length.
[[nodiscard]] constexpr std::size_t encode(const Frame& frame, std::span<char, longest_message> message) {
  char* to = message.data();
  for (const char character : frame.remote ? std::string_view{"< sendrtr "} : std::string_view{"< send "}) {
    *to++ = character;
  }
  to = slcan::put_hex(to, frame.id, frame.extended ? 8 : 3);
  *to++ = ' ';
  to = slcan::put_hex(to, frame.size, 1);
  for (std::uint8_t i = 0; i < frame.size && !frame.remote; ++i) {
    *to++ = ' ';
    to = slcan::put_hex(to, frame.data[i], 2);
  }
  *to++ = ' ';
  *to++ = '>';
  return static_cast<std::size_t>(to - message.data());
}

/// Reads identifier and data of `frame`, or identifier and length of `rtr`: the text after that word. Data bytes may be
/// separated or not.
[[nodiscard]] constexpr std::optional<Frame> decode(std::string_view text, bool remote) {
  Frame frame{};
  const std::string_view digits = take_word(text);
  const std::optional<std::uint32_t> id = slcan::hex_number(digits);
  if (!id || *id > 0x1FFF'FFFF) return std::nullopt;
  frame.id = *id;
  frame.extended = digits.size() == 8 || *id > 0x7FF;
  frame.remote = remote;
  if (take_word(text).find('.') == std::string_view::npos) return std::nullopt;  // the time
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (remote) {
      const std::optional<std::uint32_t> size = slcan::hex_number(word);
      if (!size || *size > 8) return std::nullopt;
      frame.size = static_cast<std::uint8_t>(*size);
      continue;
    }
    while (!word.empty()) {
      const std::optional<std::uint32_t> byte = slcan::hex_number(word.substr(0, 2));
      if (!byte || frame.size == 8) return std::nullopt;
      frame.data[frame.size++] = static_cast<std::uint8_t>(*byte);
      word.remove_prefix(word.size() < 2 ? word.size() : 2);
    }
  }
  return frame;
}

/// Assembles characters to messages: the text between `<` and `>`. A message that is interrupted by another one, or too
/// long to be valid, is ignored.
class MessageReader {
 public:
  /// Returns the message that this character ends; valid until the next call.
  [[nodiscard]] std::optional<std::string_view> take(char character) {
    if (character == '<') {
      size_ = 0;
      inside_ = true;
    } else if (character == '>' && inside_) {
      inside_ = false;
      return std::string_view{text_.data(), size_};
    } else if (inside_) {
      inside_ = size_ < text_.size();
      if (inside_) text_[size_++] = character;
    }
    return std::nullopt;
  }

 private:
  std::array<char, 128> text_{};
  std::uint8_t size_ = 0;
  bool inside_ = false;
};

}  // namespace socketcand

/// One bus of a server. `output` is what the client needs to write.
class SocketcandClient {
 public:
  enum class State : std::uint8_t { connecting, open, refused };
  static constexpr std::size_t longest_message = socketcand::longest_message;
  static constexpr std::size_t longest_name = 16;
  static constexpr std::string_view farewell = "";

  /// Waits for the server's greeting, then opens a bus with a name of up to 16 characters. The name must outlive
  /// the client.
  void start(std::string_view bus, TimePoint /*now*/) { bus_ = bus; }

  [[nodiscard]] State state() const {
    if (step_ == Step::open) return State::open;
    return step_ == Step::refused ? State::refused : State::connecting;
  }

  /// Returns why the bus was rejected.
  [[nodiscard]] std::string_view problem() const { return {problem_.data(), problem_size_}; }

  /// Returns the status of the bus's controller, from the server's error frames: on or off the bus.
  [[nodiscard]] BusStatus status() const { return status_; }

  /// Processes a character of the server; returns the frame that it ends, if any.
  [[nodiscard]] std::optional<Frame> on_character(char character, TimePoint /*now*/) {
    const std::optional<std::string_view> message = reader_.take(character);
    if (!message) return std::nullopt;
    std::string_view text = *message;
    const std::string_view word = socketcand::take_word(text);
    if (step_ == Step::open) {
      if (word == "error") on_error(text);
      const bool remote = word == "rtr";
      return word == "frame" || remote ? socketcand::decode(text, remote) : std::nullopt;
    }
    if (word == "error") refuse(text);
    if (step_ == Step::greeting && word == "hi") {
      put("< open ");
      put(bus_);
      put(" >");
      step_ = Step::opening;
    } else if (step_ == Step::opening && word == "ok") {
      put("< rawmode >");
      step_ = Step::switching;
    } else if (step_ == Step::switching && word == "ok") {
      step_ = Step::open;
    }
    return std::nullopt;
  }

  void on_time(TimePoint /*now*/) {}
  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return std::nullopt; }

  /// Returns what must be written before any frame; call `output_taken` when that has been done.
  [[nodiscard]] std::string_view output() const { return {output_.data(), output_size_}; }
  void output_taken() { output_size_ = 0; }

  [[nodiscard]] static std::size_t encode(const Frame& frame, std::span<char, longest_message> message) {
    return socketcand::encode(frame, message);
  }

 private:
  enum class Step : std::uint8_t { greeting, opening, switching, open, refused };

  void refuse(std::string_view text) {
    problem_size_ = 0;
    for (const char character : text) {
      const bool printable = character >= ' ' && character <= '~';
      if (printable && problem_size_ < problem_.size()) problem_[problem_size_++] = character;
    }
    step_ = Step::refused;
  }

  /// Processes an error: the class of an error frame (linux/can/error.h) and a time; other errors are responses.
  void on_error(std::string_view text) {
    constexpr std::uint32_t bus_off = 0x040;
    constexpr std::uint32_t restarted = 0x100;
    const std::optional<std::uint32_t> error = slcan::hex_number(socketcand::take_word(text));
    if (!error || socketcand::take_word(text).find('.') == std::string_view::npos) return;
    if ((*error & restarted) != 0) status_.state = BusState::active;
    if ((*error & bus_off) != 0) status_.state = BusState::off;
  }

  void put(std::string_view text) {
    for (const char character : text) {
      if (output_size_ < output_.size()) output_[output_size_++] = character;
    }
  }

  socketcand::MessageReader reader_;
  std::array<char, 32> output_{};
  std::uint8_t output_size_ = 0;
  std::array<char, 64> problem_{};
  std::uint8_t problem_size_ = 0;
  Step step_ = Step::greeting;
  std::string_view bus_;
  BusStatus status_;
};

}  // namespace canopen
