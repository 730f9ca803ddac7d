/// Time as the services see it: 32-bit microseconds since start, handed in by the application or a port.
#pragma once

#include <chrono>
#include <cstdint>

namespace canopen {

/// A span of time, 0 us to 71 minutes. Other std::chrono durations convert to it.
using Duration = std::chrono::duration<std::uint32_t, std::micro>;

/// A moment since start. It wraps every 71 minutes; two moments compare rightly as long as they are less than half of
/// that apart.
class TimePoint {
 public:
  constexpr TimePoint() = default;
  constexpr explicit TimePoint(Duration since_start) : microseconds_{since_start.count()} {}

  [[nodiscard]] constexpr Duration since_start() const { return Duration{microseconds_}; }

  friend constexpr TimePoint operator+(TimePoint time, Duration span) {
    return TimePoint{Duration{time.microseconds_ + span.count()}};
  }
  /// How long `later` is behind `earlier`.
  friend constexpr Duration operator-(TimePoint later, TimePoint earlier) {
    return Duration{later.microseconds_ - earlier.microseconds_};
  }
  friend constexpr bool operator==(TimePoint, TimePoint) = default;
  friend constexpr bool operator<(TimePoint a, TimePoint b) { return ahead(a, b) < 0; }
  friend constexpr bool operator>(TimePoint a, TimePoint b) { return ahead(a, b) > 0; }
  friend constexpr bool operator<=(TimePoint a, TimePoint b) { return ahead(a, b) <= 0; }
  friend constexpr bool operator>=(TimePoint a, TimePoint b) { return ahead(a, b) >= 0; }

 private:
  static constexpr std::int32_t ahead(TimePoint a, TimePoint b) {
    return static_cast<std::int32_t>(a.microseconds_ - b.microseconds_);
  }

  std::uint32_t microseconds_ = 0;
};

/// Whether a moment that is one period ahead at most is yet to come. It may be over for longer than moments compare, as
/// what is due waits for room on the bus.
[[nodiscard]] constexpr bool is_within(TimePoint due, Duration period, TimePoint now) {
  return (due - now).count() - 1u < period.count();
}

/// The longest time that may pass until a moment that others are compared with: 35 minutes.
inline constexpr Duration longest_span{0x7FFF'FFFF};

/// Whether a moment that is one event or inhibit time ahead at most is yet to come: of 65,535 units of so many us.
[[nodiscard]] constexpr bool is_ahead(TimePoint due, std::uint32_t unit, TimePoint now) {
  return is_within(due, Duration{0xFFFF * unit}, now);
}

/// A time as 1017h or 1800h:05 hold it.
[[nodiscard]] constexpr Duration from_milliseconds(std::uint16_t count) { return Duration{count * 1000u}; }

/// A time as 1015h holds it, and 1800h:03 by default: in units of 100 us.
[[nodiscard]] constexpr Duration from_hundred_microseconds(std::uint16_t count) { return Duration{count * 100u}; }

}  // namespace canopen
