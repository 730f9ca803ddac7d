/// Plays a trace against a generated device.
#pragma once

#include <array>
#include <canopen/node.hpp>
#include <cstring>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "trace.hpp"

namespace trace {

struct Failure {
  std::size_t line;
  std::string message;
};

/// Keeps what the device sends until the trace asks for it.
struct Outbox {
  std::deque<canopen::Frame> frames;
  bool send(const canopen::Frame& frame) {
    frames.push_back(frame);
    return true;
  }
};

template <class Device>
class Player {
 public:
  explicit Player(const Trace& trace) : trace_{trace}, node_{outbox_, trace.node_id} {}

  /// All places where the device does something else than the trace.
  std::vector<Failure> play() {
    node_.start(now_);
    if (!trace_.power_on) outbox_.frames.clear();
    for (const Line& line : trace_.lines) {
      switch (line.step) {
        case Step::set:
          expect_silence(line);
          set(line);
          break;
        case Step::pass:
          expect_silence(line);
          pass(line.span);
          break;
        case Step::send:
          expect_silence(line);
          send(line);
          break;
        case Step::expect: expect(line); break;
        case Step::read: read(line); break;
      }
    }
    if (!trace_.lines.empty()) expect_silence(trace_.lines.back());
    return failures_;
  }

 private:
  void fail(const Line& line, std::string message) { failures_.push_back({line.number, std::move(message)}); }

  /// All frames that the device has sent must have been in the trace.
  void expect_silence(const Line& before) {
    for (const canopen::Frame& frame : outbox_.frames) fail(before, "up to here not expected: " + to_text(frame));
    outbox_.frames.clear();
  }

  void send(const Line& line) {
    node_.on_frame(line.pattern.frame, now_);
    node_.on_time(now_);
  }

  void pass(canopen::Duration span) {
    const canopen::TimePoint end = now_ + span;
    while (const auto deadline = node_.next_deadline()) {
      if (*deadline > end) break;
      if (*deadline > now_) now_ = *deadline;
      node_.on_time(now_);
    }
    now_ = end;
    node_.on_time(now_);
  }

  void expect(const Line& line) {
    if (outbox_.frames.empty()) return fail(line, "expected: " + to_text(line.pattern) + "\n  got:      nothing");
    const canopen::Frame got = outbox_.frames.front();
    outbox_.frames.pop_front();
    if (!line.pattern.matches(got)) fail(line, "expected: " + to_text(line.pattern) + "\n  got:      " + to_text(got));
  }

  /// The bytes of the trace's value in an entry of this size; of texts their characters.
  static std::vector<std::uint8_t> bytes_of(const Value& value, std::size_t size) {
    if (value.is_text) return {value.text.begin(), value.text.end()};
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value.number >> (8 * i)));
    return bytes;
  }

  void set(const Line& line) {
    const canopen::entry::Word word = Device::dictionary.find(line.index, line.sub_index);
    const auto bytes = bytes_of(line.value, canopen::entry::wire_bytes(word));
    const canopen::AbortCode code = node_.set(line.index, line.sub_index, bytes);
    if (code != canopen::ok) fail(line, "the application cannot set it: " + std::string{canopen::to_text(code)});
    node_.on_time(now_);
  }

  void read(const Line& line) {
    const canopen::entry::Word word = Device::dictionary.find(line.index, line.sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return fail(line, "the device has no such object");
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = node_.entries().read(word, scratch);
    const std::vector<std::uint8_t> got{bytes.begin(), bytes.end()};
    const auto expected = bytes_of(line.value, canopen::entry::wire_bytes(word));
    if (got != expected) fail(line, "expected: " + hex(expected) + "\n  got:      " + hex(got));
  }

  static std::string hex(const std::vector<std::uint8_t>& bytes) {
    constexpr auto digits = "0123456789ABCDEF";
    std::string text;
    for (const std::uint8_t byte : bytes) text += std::string{digits[byte >> 4], digits[byte & 15], ' '};
    return text;
  }

  const Trace& trace_;
  Outbox outbox_;
  canopen::TimePoint now_{};
  canopen::Node<Device, Outbox> node_;
  std::vector<Failure> failures_;
};

template <class Device>
[[nodiscard]] std::vector<Failure> play(const Trace& trace) {
  return Player<Device>{trace}.play();
}

}  // namespace trace
