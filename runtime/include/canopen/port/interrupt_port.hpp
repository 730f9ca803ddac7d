/// A CAN controller that receives in its interrupt, so that no frame is lost while the loop is busy or asleep.
///
///     canopen::BxCan<> can{...};
///     canopen::InterruptPort<canopen::BxCan<>, 32> bus{can};
///     extern "C" void CEC_CAN_IRQHandler() { bus.on_interrupt(); }
///
/// If the chip has several vectors, that of FIFO 0 calls `on_interrupt` and the others call `on_other_interrupt`:
///
///     extern "C" void CAN1_RX0_IRQHandler() { bus.on_interrupt(); }
///     extern "C" void CAN1_TX_IRQHandler() { bus.on_other_interrupt(); }
///     extern "C" void CAN1_SCE_IRQHandler() { bus.on_other_interrupt(); }
///
///     const bool up = can.start(48'000'000, 500'000);
///     bus.enable_interrupts();                         // and the line at the interrupt controller of the core
///     for (;;) {
///       while (const auto frame = bus.receive()) node.on_frame(*frame, now());
///       if (const auto status = bus.status_change()) node.on_bus_status(*status, now());
///       node.on_time(now());
///     }
#pragma once

#include <atomic>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>

#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/receive_queue.hpp"
#include "canopen/port/can_controller.hpp"

namespace canopen {

/// A driver whose controller has an interrupt for received frames and for mailboxes that have become free. If it has
/// one for the status as well, `acknowledge_interrupts` returns whether it was that, and `has_status_interrupt` is
/// true.
template <class Type>
concept InterruptingController = CanController<Type> && requires(Type& can) {
  can.enable_interrupts();
  can.acknowledge_interrupts();
};

/// `on_interrupt` runs in the interrupt of the controller; all other functions run in the loop of the node. A mailbox
/// that becomes free also interrupts: it wakes a sleeping core, and the next `on_time` of the node sends what waits.
template <InterruptingController Can, std::size_t Capacity = 16>
class InterruptPort {
 public:
  explicit constexpr InterruptPort(Can& driver) : can_{driver} {}

  static constexpr bool has_status_interrupt = canopen::has_status_interrupt<Can>;

  /// Moves all frames of the controller to the queue. Only one vector may call it: the queue has one producer.
  void on_interrupt() {
    on_other_interrupt();
    while (const std::optional<Frame> frame = can_.receive()) queue_.push(*frame);
  }

  /// In a vector of its own for mailboxes that have become free, or for the status. May be of another priority.
  void on_other_interrupt() {
    if constexpr (has_status_interrupt) {
      if (can_.acknowledge_interrupts()) status_interrupt_.store(true, std::memory_order_release);
    } else {
      can_.acknowledge_interrupts();
    }
  }

  void enable_interrupts() { can_.enable_interrupts(); }

  /// Returns the next received frame, if any.
  [[nodiscard]] std::optional<Frame> receive() { return queue_.pop(); }

  /// Whether the loop may sleep until the next interrupt or deadline.
  [[nodiscard]] bool idle() const {
    return queue_.empty() && !(has_status_interrupt && status_interrupt_.load(std::memory_order_acquire));
  }

  [[nodiscard]] bool send(const Frame& frame) { return can_.send(frame); }
  void accept_all() { can_.accept_all(); }
  void accept(std::span<const AcceptedFrame> frames) { can_.accept(frames); }

  /// Returns the status of the controller if it has changed; frames without room in the queue are an overrun as well.
  [[nodiscard]] std::optional<BusStatus> status_change() {
    status_interrupt_.store(false, std::memory_order_relaxed);  // before the look: a later interrupt sets it again
    std::atomic_signal_fence(std::memory_order_seq_cst);
    if (const std::optional<BusStatus> changed = can_.status_change()) {
      state_ = changed->state;
      if (changed->overrun) report_.note_overrun();
    }
    if (queue_.take_overruns() != 0) report_.note_overrun();
    return report_.change(state_);
  }

 private:
  Can& can_;
  ReceiveQueue<Capacity> queue_;
  std::atomic<bool> status_interrupt_{false};
  BusState state_ = BusState::active;
  StatusReport report_;
};

}  // namespace canopen
