/// A node in a task of an operating system: it works when a frame arrives or a deadline has come, and waits otherwise.
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"

namespace canopen {

/// What a node task needs of an operating system: `FreeRtos`, `Zephyr`, or a class of the application.
template <class Type>
concept TaskSystem = requires(Type& system, Duration span) {
  { system.now() } -> std::same_as<TimePoint>;
  system.wait(span);  ///< until `wake`, also one before the call, or until the time has passed
  system.wake();      ///< from any task
  { system.shortest_wait() } -> std::same_as<Duration>;
};

/// Received frames, such as InterruptPort.
template <class Type>
concept FrameSource = requires(Type& port) {
  { port.receive() } -> std::same_as<std::optional<Frame>>;
};

/// Runs a node with the frames of a port. The interrupt of the CAN controller calls `wake` of the system after it has
/// moved the frames to the port, when a mailbox has become free, and for error passive and bus-off; so does each
/// context that posts to a Mailbox. All three must outlive this object. `Node` may be a `Locked`.
template <class Node, FrameSource Port, TaskSystem System>
class NodeTask {
 public:
  constexpr NodeTask(Node& task_node, Port& source, System& task_system)
      : node_{task_node}, port_{source}, system_{task_system} {}

  /// Starts the node and runs it. Does not return.
  [[noreturn]] void run() {
    node_.start(system_.now());
    for (;;) run_once();
  }

  /// Processes what has been received and what is due, then waits once.
  void run_once() {
    while (const std::optional<Frame> frame = port_.receive()) node_.on_frame(*frame, system_.now());
    if constexpr (requires { port_.status_change(); }) {
      if (const std::optional<BusStatus> status = port_.status_change()) {
        state_ = status->state;
        node_.on_bus_status(*status, system_.now());
      }
    }
    node_.on_time(system_.now());
    system_.wait(time_to_wait());
  }

 private:
  /// A node must be called every half hour at least.
  static constexpr Duration longest_wait{900'000'000};
  /// How often the status of a port is looked at that has no interrupt for it, or whose controller is not error active:
  /// not every controller interrupts when it becomes so again.
  static constexpr Duration look_at_status{100'000};

  [[nodiscard]] Duration most() const {
    if constexpr (requires(Port & port) { port.status_change(); }) {
      if (!has_status_interrupt<Port> || state_ != BusState::active) return look_at_status;
    }
    return longest_wait;
  }

  /// Not less than the shortest wait: what is due after `on_time` waits for room on the bus or for the flash, and tasks
  /// of lower priority must run meanwhile.
  [[nodiscard]] Duration time_to_wait() {
    const std::optional<TimePoint> due = node_.next_deadline();
    if (!due) return most();
    const TimePoint now = system_.now();
    if (*due <= now) return system_.shortest_wait();
    return std::clamp(*due - now, system_.shortest_wait(), std::max(most(), system_.shortest_wait()));
  }

  Node& node_;
  Port& port_;
  System& system_;
  BusState state_ = BusState::active;
};

}  // namespace canopen
