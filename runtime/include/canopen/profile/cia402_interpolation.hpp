/// Interpolation between the set-points of a master: 60C1h, 60C2h and 60C4h (CiA 402-2, interpolated position mode).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"

namespace canopen::cia402 {

/// Returns the interpolation time period 60C2h, at most 2 s; 1 ms without it.
template <class DriveParameters, class Node>
[[nodiscard]] Duration interpolation_period(const Node& node) {
  const int index{DriveParameters::template value<object::InterpolationTimeIndex>(node, -3)};
  std::uint32_t period = DriveParameters::template value<object::InterpolationTimeUnits>(node, 1);
  constexpr std::uint32_t longest = 2'000'000;
  for (int i = -6; i < index && period < longest; ++i) period *= 10;
  for (int i = index; i < -6; ++i) period /= 10;
  return Duration{period < longest ? period : longest};
}

/// A value that moves linearly from one set-point to the next in a time.
class LinearMotion {
 public:
  /// The next motion has no predecessor.
  void clear() { begun_ = false; }
  [[nodiscard]] bool begun() const { return begun_; }

  void begin(std::int32_t from, std::int32_t to) {
    begun_ = true;
    from_ = from;
    to_ = to;
    elapsed_ = Duration{0};
  }
  /// Begins at the end of the last one.
  void go_on(std::int32_t to) { begin(to_, to); }

  void step(Duration span, Duration period) {
    if (!over(period)) elapsed_ += span;
  }

  [[nodiscard]] bool over(Duration period) const { return elapsed_ >= period; }
  [[nodiscard]] std::int32_t target() const { return to_; }
  [[nodiscard]] std::int32_t value(Duration period) const {
    if (over(period)) return to_;
    const std::int64_t way = std::int64_t{to_} - from_;
    return static_cast<std::int32_t>(from_ + way * std::int64_t{elapsed_.count()} / std::int64_t{period.count()});
  }

 private:
  std::int32_t from_ = 0;
  std::int32_t to_ = 0;
  Duration elapsed_{0};
  bool begun_ = false;
};

/// The data records of interpolated position mode, first in, first out, and the motion between them. One record in each
/// period 60C2h; if there is none, the position is held.
template <class DriveParameters, Options options>
class InterpolatedPosition {
  static constexpr bool has_buffer = DriveParameters::template has<object::InterpolationBufferClear>;
  static constexpr std::size_t room = has_buffer ? options.interpolation_buffer : 1;
  static_assert(room > 0 && room <= 255, "options.interpolation_buffer of a drive with 60C4h is 1 to 255");

 public:
  void clear() { *this = InterpolatedPosition{}; }

  /// Takes a data record that has been written to 60C1h:01, even if it is the same as the last one. device_state: the
  /// buffer is full, or 60C4h:06 disables it. Without 60C4h, the newest record replaces one that waits.
  template <class Node>
  AbortCode offer(const Node& node, std::int32_t position) {
    if constexpr (has_buffer) {
      if (!enabled(node) || count_ >= size(node)) return AbortCode::device_state;
      records_[(first_ + count_) % room] = position;
      ++count_;
    } else {
      records_[0] = position;
      count_ = 1;
    }
    return ok;
  }

  /// A SYNC has been received. `is_clock`: a period begins with each SYNC.
  void on_sync(bool is_clock) { synchronous_ = at_sync_ = is_clock; }

  /// Whether the motion is interpolated: bit 12 of the statusword.
  [[nodiscard]] bool active() const { return active_; }
  /// Whether there is nothing more to do.
  [[nodiscard]] bool at_rest() const { return !active_ || (count_ == 0 && resting_); }

  /// Processes bit 4 of the controlword and the elapsed time. Returns the position at the end of the step; `demand`,
  /// the present one, while it is not active.
  template <class Node>
  [[nodiscard]] std::int32_t step(const Node& node, bool enable, std::int32_t demand, Duration span) {
    if (has_buffer && !enabled(node)) count_ = 0;
    if (!enable) {
      active_ = false;
      return demand;
    }
    const Duration period = interpolation_period<DriveParameters>(node);
    if (!active_) {
      active_ = true;
      motion_.begin(demand, demand);
      motion_.step(period, period);
    }
    const bool due = synchronous_ ? at_sync_ : motion_.over(period);
    if (due && count_ != 0) {
      if (motion_.over(period)) {
        motion_.go_on(take());
      } else {
        motion_.begin(motion_.value(period), take());
      }
    }
    at_sync_ = false;
    motion_.step(span, period);
    resting_ = motion_.over(period);
    return motion_.value(period);
  }

 private:
  template <class Node>
  [[nodiscard]] static bool enabled(const Node& node) {
    return DriveParameters::template value<object::InterpolationBufferClear>(node, 1) != 0;
  }
  /// Returns 60C4h:02, at most what there is room for; all of it if it is 0.
  template <class Node>
  [[nodiscard]] static std::size_t size(const Node& node) {
    const std::uint32_t wanted = DriveParameters::template value<object::InterpolationBufferSize>(node, 0);
    return wanted == 0 || wanted > room ? room : wanted;
  }

  [[nodiscard]] std::int32_t take() {
    const std::int32_t position = records_[first_];
    first_ = static_cast<std::uint8_t>((first_ + 1) % room);
    --count_;
    return position;
  }

  std::uint8_t first_ = 0;
  std::uint8_t count_ = 0;
  bool active_ = false;
  bool resting_ = true;
  bool synchronous_ = false;  ///< periods begin with SYNC
  bool at_sync_ = false;      ///< one has been received since the last step
  LinearMotion motion_{};
  std::array<std::int32_t, room> records_{};
};

}  // namespace canopen::cia402
