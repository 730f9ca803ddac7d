/// A bus that stores the frame: its instructions are in the figures.
#pragma once

#include <canopen/can/frame.hpp>
#include <cstdint>

class CountedBus {
 public:
  [[gnu::noinline]] bool send(const canopen::Frame& frame) {
    const canopen::FrameWords words = canopen::words_of(frame);
    id_ = frame.id;
    words_[0] = words.first;
    words_[1] = words.second;
    ++sent_;
    return true;
  }
  [[nodiscard]] std::uint32_t sent() const { return sent_; }
  /// Returns the first byte of the last frame, the command of an SDO response.
  [[nodiscard]] std::uint8_t last_command() const { return static_cast<std::uint8_t>(words_[0]); }

 private:
  volatile std::uint32_t id_ = 0;
  volatile std::uint32_t words_[2]{};
  std::uint32_t sent_ = 0;
};
