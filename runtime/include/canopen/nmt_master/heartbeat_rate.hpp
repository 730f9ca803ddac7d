/// Measures whether a node sends its heartbeats at the rate of 1017h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "canopen/base/clock.hpp"
#include "canopen/nmt/error_control.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Heartbeats at twice the rate, or with different states, are those of two nodes with one node-ID. The measurement
/// begins with the first heartbeat and takes two heartbeat times, which is enough for the heartbeats of a second node,
/// and at least 200 ms, because frames may be delayed. A wrong rate is measured three times: a heartbeat that a busy
/// machine reads late shortens one measurement. Heartbeat times of more than a second are not measured.
class HeartbeatRate {
 public:
  enum class Verdict : std::uint8_t {
    open,    ///< not known yet
    right,   ///< or not measured
    wrong,   ///< too many or too few heartbeats
    states,  ///< they have different states
  };

  /// Starts again. `producer_time` is 1017h in ms; 0: unknown.
  void begin(std::uint16_t producer_time) {
    *this = HeartbeatRate{};
    producer_time_ = producer_time;
  }

  /// The node has got a command that changes its state; a heartbeat may be on its way.
  void expect_state_change() {
    state_ = LastState{};
    is_state_skipped_ = true;
  }

  /// Whether the rate is measured.
  [[nodiscard]] bool is_measured() const { return producer_time_ != 0 && producer_time_ <= 1000; }
  [[nodiscard]] bool begun() const { return heartbeats_ != 0; }
  [[nodiscard]] std::uint16_t producer_time() const { return producer_time_; }

  /// Processes a heartbeat.
  void report(NmtState state, TimePoint now) {
    if (heartbeats_ == 0) first_ = now;
    if (!std::exchange(is_state_skipped_, false)) {
      states_differ_ = states_differ_ || (state_.known() && state_ != LastState{state});
      state_ = LastState{state};
    }
    if (heartbeats_ > periods()) return;
    ++heartbeats_;
    last_ = now;
  }

  /// Returns when the measurement ends, after its first heartbeat.
  [[nodiscard]] TimePoint end() const { return first_ + span() / 5 * 8; }

  [[nodiscard]] Verdict verdict(TimePoint now) const {
    if (states_differ_) return Verdict::states;
    if (!is_measured()) return Verdict::right;
    const bool is_complete = heartbeats_ > periods();
    if (!is_complete) return heartbeats_ != 0 && now < end() ? Verdict::open : Verdict::wrong;
    return (last_ - first_).count() / 2 >= span().count() / 3 ? Verdict::right : Verdict::wrong;
  }

  /// Measures a wrong rate again, from the last heartbeat, or from the next one if too few have been received. Returns
  /// false if this was the last measurement.
  [[nodiscard]] bool repeat() {
    if (measurements_ == max_measurements) return false;
    ++measurements_;
    heartbeats_ = heartbeats_ > periods() ? 1 : 0;
    first_ = last_;
    return true;
  }

  /// Returns the measured distance of two heartbeats in ms.
  [[nodiscard]] std::uint32_t measured_time(TimePoint now) const {
    const bool is_complete = heartbeats_ > periods();
    const std::uint32_t count = heartbeats_ < 2 ? 1u : heartbeats_ - 1u;
    return ((is_complete ? last_ : now) - first_).count() / count / 1000u;
  }

 private:
  static constexpr std::uint8_t max_measurements = 3;

  [[nodiscard]] std::uint8_t periods() const {
    constexpr unsigned shortest = 200;  // ms
    const unsigned time = producer_time_ == 0 ? shortest : producer_time_;
    return static_cast<std::uint8_t>(std::max((shortest + time - 1) / time, 2u));
  }
  [[nodiscard]] Duration span() const { return from_milliseconds(producer_time_) * periods(); }

  TimePoint first_{};
  TimePoint last_{};
  std::uint16_t producer_time_ = 0;
  std::uint8_t heartbeats_ = 0;  ///< until the measurement is complete
  std::uint8_t measurements_ = 1;
  LastState state_{};  ///< of the last one
  bool is_state_skipped_ = false;
  bool states_differ_ = false;
};

}  // namespace canopen
