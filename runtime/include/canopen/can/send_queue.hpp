/// Frames that wait for room on the bus, in the order of arbitration.
#pragma once

#include <array>
#include <cstddef>

#include "canopen/can/arbitration.hpp"
#include "canopen/can/frame.hpp"

namespace canopen {

/// Queue of up to `Capacity` frames. Frames with the same CAN-ID keep their order.
template <std::size_t Capacity>
class SendQueue {
 public:
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] bool full() const { return count_ == Capacity; }
  [[nodiscard]] std::size_t size() const { return count_; }

  /// Returns the next frame to be sent. The queue must not be empty.
  [[nodiscard]] const Frame& front() const { return frames_[count_ - 1]; }
  void pop() { --count_; }
  void clear() { count_ = 0; }

  /// Adds a frame. Returns false if the queue is full.
  [[nodiscard]] bool push(const Frame& frame) {
    if (full()) return false;
    const std::uint64_t value = arbitration_value(frame);
    std::size_t at = count_;
    for (; at > 0 && arbitration_value(frames_[at - 1]) <= value; --at) frames_[at] = frames_[at - 1];
    frames_[at] = frame;
    ++count_;
    return true;
  }

 private:
  std::array<Frame, Capacity> frames_{};  ///< the last one is sent first
  std::size_t count_ = 0;
};

}  // namespace canopen
