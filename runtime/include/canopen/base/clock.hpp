/// Time as the services see it: 32-bit microseconds since start, handed in by the application or a port.
#pragma once

#include <cstdint>
#include <ratio>

// Since C++20, <chrono> of libstdc++ includes streams and locales: a quarter of a second for each file. Durations and
// clocks alone are in this header.
#if defined(__GLIBCXX__) && __has_include(<bits/chrono.h>)
#include <bits/chrono.h>
#else
#include <chrono>
#endif

namespace canopen {

/// A duration, 0 us to 71 minutes. Other std::chrono durations convert to it.
using Duration = std::chrono::duration<std::uint32_t, std::micro>;

/// A point in time since start. It wraps every 71 minutes: comparisons are valid if two points are less than half of
/// that apart.
class TimePoint {
 public:
  constexpr TimePoint() = default;
  constexpr explicit TimePoint(Duration since_start) : microseconds_{since_start.count()} {}

  [[nodiscard]] constexpr Duration since_start() const { return Duration{microseconds_}; }

  friend constexpr TimePoint operator+(TimePoint time, Duration span) {
    return TimePoint{Duration{time.microseconds_ + span.count()}};
  }
  friend constexpr TimePoint operator-(TimePoint time, Duration span) {
    return TimePoint{Duration{time.microseconds_ - span.count()}};
  }
  /// Returns the time from `earlier` to `later`.
  friend constexpr Duration operator-(TimePoint later, TimePoint earlier) {
    return Duration{later.microseconds_ - earlier.microseconds_};
  }
  friend constexpr bool operator==(TimePoint, TimePoint) = default;
  friend constexpr bool operator<(TimePoint a, TimePoint b) { return ahead(a, b) < 0; }
  friend constexpr bool operator>(TimePoint a, TimePoint b) { return ahead(a, b) > 0; }
  friend constexpr bool operator<=(TimePoint a, TimePoint b) { return ahead(a, b) <= 0; }
  friend constexpr bool operator>=(TimePoint a, TimePoint b) { return ahead(a, b) >= 0; }

  /// Whether `time` was more than this span ago, and not more than 35 minutes.
  friend constexpr bool is_before(TimePoint time, Duration span, TimePoint now) {
    return ahead(now, time) > static_cast<std::int32_t>(span.count());
  }

 private:
  static constexpr std::int32_t ahead(TimePoint a, TimePoint b) {
    return static_cast<std::int32_t>(a.microseconds_ - b.microseconds_);
  }

  std::uint32_t microseconds_ = 0;
};

/// Whether `due`, set at most one period ahead, is still ahead. It may have passed longer ago than comparisons allow,
/// because what is due may wait for room on the bus.
[[nodiscard]] constexpr bool is_within(TimePoint due, Duration period, TimePoint now) {
  return (due - now).count() - 1u < period.count();
}

/// Maximum time between two points that are compared: 35 minutes.
inline constexpr Duration longest_span{0x7FFF'FFFF};

/// Whether `due`, set at most one event or inhibit time ahead, is still ahead: at most 65,535 times `unit` us.
[[nodiscard]] constexpr bool is_ahead(TimePoint due, std::uint32_t unit, TimePoint now) {
  return is_within(due, Duration{0xFFFF * unit}, now);
}

/// Converts a time in ms, as in 1017h or 1800h:05.
[[nodiscard]] constexpr Duration from_milliseconds(std::uint16_t count) { return Duration{count * 1000u}; }

/// Converts a time in units of 100 us, as in 1015h and, by default, 1800h:03.
[[nodiscard]] constexpr Duration from_hundred_microseconds(std::uint16_t count) { return Duration{count * 100u}; }

}  // namespace canopen
