/// Runs a node on a port of a host; common to all ports. A port provides, in addition to `send`,
///
///     std::optional<PortEvent> take();                     // the next event, without waiting
///     std::optional<TimePoint> next_deadline();            // when `take` has something to do by itself
///     Duration hold_off();                                 // how long to wait after a rejected frame; 0: none
///     bool has_more();                                     // frames wait that no descriptor reports
///     TimePoint pass_time();                               // now; no later frame has an earlier time
///     EventDescriptor& events();
#pragma once

#include <algorithm>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/bus_status.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/host/event_descriptor.hpp"
#include "canopen/node/accepted_frames.hpp"

namespace canopen {

/// A received frame, or a change of the bus status.
struct PortEvent {
  std::optional<Frame> frame;  ///< empty: the status has changed
  TimePoint time;
  BusStatus status;
};

namespace host_loop {

inline constexpr Duration look_at_stop{100'000};
inline constexpr Duration try_again{1'000};     ///< after a frame for which there was no room
inline constexpr Duration look_again{100'000};  ///< interval of checks whether a bus that is off or down is back
inline const std::atomic<bool> never{false};    ///< as `stop`: runs until the process ends
inline constexpr std::size_t burst = 64;        ///< maximum number of frames between two checks of the deadlines

/// Passes events to the node, and the present time, which it returns.
template <class Port, class Node>
TimePoint serve_once(Port& port, Node& node) {
  if constexpr (requires { port.listen_for(node); }) port.listen_for(node);
  for (std::size_t i = 0; i < burst; ++i) {
    const std::optional<PortEvent> event = port.take();
    if (!event) break;
    if (event->frame) {
      node.on_frame(*event->frame, event->time);
    } else if constexpr (requires { node.on_bus_status(event->status, event->time); }) {
      node.on_bus_status(event->status, event->time);
    }
  }
  const TimePoint now = port.pass_time();
  node.on_time(now);
  return now;
}

/// Returns the next event that does not make a descriptor readable. A bus without room delays what is to be sent, but
/// not the periodic functions of the application.
template <class Port, class Node>
[[nodiscard]] std::optional<TimePoint> next_deadline(const Port& port, Node& node, TimePoint now) {
  std::optional<TimePoint> next = node.next_deadline();
  if (next) next = std::max(*next, now + port.hold_off());
  const auto consider = [&next](std::optional<TimePoint> time) {
    if (time && (!next || *time < *next)) next = time;
  };
  consider(port.next_deadline());
  if constexpr (requires { node.next_periodic_call(); }) consider(node.next_periodic_call());
  return next;
}

[[nodiscard]] inline Duration until(std::optional<TimePoint> deadline, TimePoint now, Duration most) {
  if (!deadline) return most;
  return *deadline > now ? std::min(*deadline - now, most) : Duration{0};
}

template <class Port, class Node>
void serve(Port& port, Node& node) {
  port.events().take_wake();
  const TimePoint now = serve_once(port, node);
  port.events().set_alarm(next_deadline(port, node, now), now);
}

template <class Port, class Node>
void run(Port& port, Node& node, const std::atomic<bool>& stop) {
  node.start(monotonic_now());
  while (!stop) {
    const TimePoint now = serve_once(port, node);
    port.events().wait(until(next_deadline(port, node, now), now, look_at_stop));
  }
}

/// Returns the next frame; empty if none is received within this time. The descriptor stays readable if there are more.
template <class Port>
[[nodiscard]] std::optional<Frame> receive(Port& port, Duration timeout) {
  const TimePoint end = monotonic_now() + timeout;
  for (;;) {
    while (const std::optional<PortEvent> event = port.take()) {
      if (event->frame) {
        if (port.has_more()) port.events().set_alarm(event->time, monotonic_now());
        return event->frame;
      }
      if (monotonic_now() >= end) break;  // the status may change continuously
    }
    const TimePoint now = monotonic_now();
    if (now >= end) {
      port.events().take_wake();
      port.events().set_alarm(port.has_more() ? std::optional{now} : port.next_deadline(), now);
      return std::nullopt;
    }
    port.events().wait(until(port.next_deadline(), now, end - now));
  }
}

}  // namespace host_loop

}  // namespace canopen
