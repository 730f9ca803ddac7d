/// The time until a node has something to do, so that a call of `on_time` before it can return at once.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>

#include "canopen/base/clock.hpp"
#include "canopen/base/deadline.hpp"
#include "canopen/base/optimization.hpp"

namespace canopen {

namespace node_detail {

/// It begins with a call of `on_time` and ends with the next event: a frame that is received, or a check of what is to
/// be sent. Its length is determined by the second call without an event in between: a node that calls `on_time` after
/// each frame would pay for a deadline that it does not use.
class IdleTime {
 public:
  /// Something has happened: deadlines may have changed.
  void end() { state_ = State::unknown; }

  /// Whether nothing is due.
  [[nodiscard]] bool lasts(TimePoint now) const { return state_ == State::known && is_within(end_, longest, now); }

  /// Whether `on_time` has been called since the last event.
  [[nodiscard]] bool has_begun() const { return state_ != State::unknown; }

  /// `on_time` has sent what was due.
  void begin() { state_ = State::begun; }
  /// The same with the earliest deadline; empty: none. One that has passed, or is far ahead, is not waited for.
  void begin(TimePoint now, std::optional<TimePoint> deadline) {
    end_ = deadline.value_or(now + longest);
    state_ = is_within(end_, longest, now) ? State::known : State::begun;
  }

 private:
  /// Services must see the time at least every half hour; the node may be called that much later.
  static constexpr Duration longest = Deadline::longest_past;

  enum class State : std::uint8_t { unknown, begun, known };

  TimePoint end_{};
  State state_ = State::unknown;
};

/// The same for an image for size, which does not need the deadlines of all services: they are checked once in each
/// slot of 128 microseconds. Times of CANopen objects are multiples of 100 microseconds, except those of SYNC.
class TimeSlots {
 public:
  static void end() {}
  /// Whether this slot has been checked.
  [[nodiscard]] bool lasts(TimePoint now) {
    const auto slot = static_cast<std::uint16_t>(now.since_start().count() >> 7);
    if (slot == checked_) return true;
    checked_ = slot;
    return false;
  }
  [[nodiscard]] static constexpr bool has_begun() { return false; }
  static void begin() {}
  static void begin(TimePoint, std::optional<TimePoint>) {}

 private:
  std::uint16_t checked_ = 0;
};

/// The same for a node that must check at each call.
class NoIdleTime {
 public:
  static void end() {}
  [[nodiscard]] static constexpr bool lasts(TimePoint) { return false; }
  [[nodiscard]] static constexpr bool has_begun() { return false; }
  static void begin() {}
  static void begin(TimePoint, std::optional<TimePoint>) {}
};

}  // namespace node_detail

/// Without slots of time, an image for size has 970 bytes more and takes 9 instructions more of a Cortex-M0+ for a call
/// of `on_time` with nothing due. For speed, slots would save 5 of a Cortex-M4, and be up to 128 us late.
template <bool checks_each_call>
using IdleTimeOf = std::conditional_t<checks_each_call, node_detail::NoIdleTime,
                                      std::conditional_t<prefers_size, node_detail::TimeSlots, node_detail::IdleTime>>;

}  // namespace canopen
