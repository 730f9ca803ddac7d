/// Frames as lines of SLCAN on the board's serial line, which is received in an interrupt.
#pragma once

#include <array>
#include <canopen/can/frame.hpp>
#include <canopen/can/receive_queue.hpp>
#include <canopen/port/slcan_codec.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "board.hpp"

/// Lines that are not frames are ignored.
class InterruptSerialBus {
 public:
  // ---- the interrupt ----

  void on_interrupt() {
    while (const std::optional<char> character = board::uart_get()) {
      const auto line = reader_.take(*character);
      if (!line) continue;
      if (const auto frame = canopen::slcan::decode(*line)) queue_.push(*frame);
    }
  }

  // ---- the loop ----

  [[nodiscard]] std::optional<canopen::Frame> receive() { return queue_.pop(); }
  [[nodiscard]] bool idle() const { return queue_.empty(); }

  [[nodiscard]] bool send(const canopen::Frame& frame) {
    if (last_ - first_ + canopen::slcan::longest_line > buffer_.size()) return false;
    std::array<char, canopen::slcan::longest_line> line;
    const std::size_t size = canopen::slcan::encode(frame, line);
    for (std::size_t i = 0; i < size; ++i) buffer_[last_++ % buffer_.size()] = line[i];
    return true;
  }

  /// Passes characters to the UART, which interrupts when it has room again.
  void flush() {
    while (first_ != last_ && board::uart_put(buffer_[first_ % buffer_.size()])) ++first_;
  }

 private:
  canopen::slcan::LineReader reader_;  ///< of the interrupt
  canopen::ReceiveQueue<32> queue_;
  std::uint32_t first_ = 0;
  std::uint32_t last_ = 0;
  std::array<char, 1024> buffer_{};  ///< characters to send; the size is a power of two
};
