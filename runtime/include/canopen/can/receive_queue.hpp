/// Received frames on their way from an interrupt, or another thread, to the loop of the node.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "canopen/base/shared_number.hpp"
#include "canopen/can/frame.hpp"

namespace canopen {

/// Queue of up to `Capacity` frames, a power of two of at most 2^15: one context calls `push`, one other context calls
/// `pop` and `take_overruns`. Neither waits for the other, and neither needs a lock. 16 bytes of RAM per frame.
template <std::size_t Capacity>
class ReceiveQueue {
  static_assert(std::has_single_bit(Capacity) && Capacity <= 0x8000, "the capacity is a power of two, at most 32768");

 public:
  // ---- the interrupt ----

  /// Adds a frame. Returns false if the queue is full: the frame is lost and counted.
  bool push(const Frame& frame) {
    const std::uint16_t tail = tail_.own();
    if (static_cast<std::uint16_t>(tail - head_.read()) == Capacity) {
      overruns_.publish(overruns_.own() + 1);
      return false;
    }
    frames_[tail % Capacity] = frame;
    tail_.publish(static_cast<std::uint16_t>(tail + 1));
    return true;
  }

  // ---- the loop ----

  /// Returns the next frame, if any.
  [[nodiscard]] std::optional<Frame> pop() {
    const std::uint16_t head = head_.own();
    if (head == tail_.read()) return std::nullopt;
    const Frame frame = frames_[head % Capacity];
    head_.publish(static_cast<std::uint16_t>(head + 1));
    return frame;
  }

  [[nodiscard]] bool empty() const { return head_.own() == tail_.read(); }

  /// Returns the number of frames that have been lost since the last call, modulo 2^32: report it to the node as
  /// `BusStatus::overrun`, which sends EMCY 8110h.
  [[nodiscard]] std::uint32_t take_overruns() {
    const std::uint32_t counted = overruns_.read();
    const std::uint32_t lost = counted - reported_;
    reported_ = counted;
    return lost;
  }

 private:
  std::array<Frame, Capacity> frames_{};
  SharedNumber<std::uint16_t> tail_;      ///< frames pushed; written by the interrupt
  SharedNumber<std::uint32_t> overruns_;  ///< written by the interrupt
  SharedNumber<std::uint16_t> head_;      ///< frames popped; written by the loop
  std::uint32_t reported_ = 0;            ///< of the loop: overruns that were reported
};

}  // namespace canopen
