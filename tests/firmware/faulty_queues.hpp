/// Queues with the interface of canopen::ReceiveQueue and one fault each, which the test of interrupts must find.
#pragma once

#include <array>
#include <atomic>
#include <canopen/base/shared_number.hpp>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace faulty {

/// What the queues have in common: places, counted frames, overruns.
template <std::size_t Capacity>
class Places {
 public:
  [[nodiscard]] std::uint32_t take_overruns() {
    const std::uint32_t lost = overruns_.own();
    overruns_.publish(0);
    return lost;
  }

 protected:
  [[nodiscard]] canopen::Frame& place(std::uint32_t number) { return frames_[number % Capacity]; }
  bool refuse() {
    overruns_.publish(overruns_.own() + 1);
    return false;
  }
  /// Keeps the compiler from putting the two halves of the fault into the right order.
  static void keep_order() { std::atomic_signal_fence(std::memory_order_seq_cst); }

  canopen::SharedNumber<std::uint32_t> tail_;
  canopen::SharedNumber<std::uint32_t> head_;

 private:
  std::array<canopen::Frame, Capacity> frames_{};
  canopen::SharedNumber<std::uint32_t> overruns_;
};

/// `pop` frees the place before it has copied the frame.
template <std::size_t Capacity>
class FreesFirst : public Places<Capacity> {
 public:
  bool push(const canopen::Frame& frame) {
    const std::uint32_t tail = this->tail_.own();
    if (tail - this->head_.read() == Capacity) return this->refuse();
    this->place(tail) = frame;
    this->tail_.publish(tail + 1);
    return true;
  }
  [[nodiscard]] std::optional<canopen::Frame> pop() {
    const std::uint32_t head = this->head_.own();
    if (head == this->tail_.read()) return std::nullopt;
    this->head_.publish(head + 1);
    this->keep_order();
    return this->place(head);
  }
};

/// `push` publishes the frame before it has copied it.
template <std::size_t Capacity>
class PublishesFirst : public Places<Capacity> {
 public:
  bool push(const canopen::Frame& frame) {
    const std::uint32_t tail = this->tail_.own();
    if (tail - this->head_.read() == Capacity) return this->refuse();
    this->tail_.publish(tail + 1);
    this->keep_order();
    this->place(tail) = frame;
    return true;
  }
  [[nodiscard]] std::optional<canopen::Frame> pop() {
    const std::uint32_t head = this->head_.own();
    if (head == this->tail_.read()) return std::nullopt;
    const canopen::Frame frame = this->place(head);
    this->head_.publish(head + 1);
    return frame;
  }
};

/// Both contexts change one number of waiting frames, which takes a load and a store.
template <std::size_t Capacity>
class SharesCount : public Places<Capacity> {
 public:
  bool push(const canopen::Frame& frame) {
    if (count_.read() == Capacity) return this->refuse();
    const std::uint32_t tail = this->tail_.own();
    this->place(tail) = frame;
    this->tail_.publish(tail + 1);
    count_.publish(count_.read() + 1);
    return true;
  }
  [[nodiscard]] std::optional<canopen::Frame> pop() {
    if (count_.read() == 0) return std::nullopt;
    const std::uint32_t head = this->head_.own();
    const canopen::Frame frame = this->place(head);
    this->head_.publish(head + 1);
    count_.publish(count_.read() - 1);
    return frame;
  }

 private:
  canopen::SharedNumber<std::uint32_t> count_;
};

}  // namespace faulty
