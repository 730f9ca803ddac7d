/// The time that a service waits for.
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"

namespace canopen {

/// A point in time, at most 35 minutes ahead, that does not become stale: once it has passed, it remains passed,
/// however long ago that was. A TimePoint alone seems to be ahead again 35 minutes later. For this, its owner calls
/// `keep` wherever it may leave a deadline that has passed as it is, at least every half hour.
///
/// Whether a deadline is in use at all is known to its owner.
class Deadline {
 public:
  constexpr Deadline() = default;
  constexpr Deadline(TimePoint at) : at_{at} {}  // NOLINT(google-explicit-constructor): a time to wait for

  [[nodiscard]] constexpr TimePoint at() const { return at_; }
  [[nodiscard]] constexpr bool is_ahead(TimePoint now) const { return at_ > now; }
  [[nodiscard]] constexpr bool has_passed(TimePoint now) const { return at_ <= now; }

  /// Moves a deadline that has passed long ago nearer to the present time.
  [[gnu::noinline]] constexpr void keep(TimePoint now) {
    if (is_before(at_, longest_past, now)) at_ = now - longest_past;
  }

  /// A deadline that has passed is at most this old after `keep`: two minutes. The next call, half an hour later, is
  /// then within the range in which two TimePoints compare.
  static constexpr Duration longest_past{0x0800'0000};

 private:
  TimePoint at_{};
};

/// Maximum time between two calls of a node: 30 minutes.
inline constexpr Duration longest_sleep = std::chrono::minutes{30};

/// Returns the earlier one of two deadlines. One that has passed is earlier than each one ahead, also if they are more
/// than 35 minutes apart.
[[nodiscard]] constexpr TimePoint earlier_deadline(TimePoint a, TimePoint b, TimePoint now) {
  if (a <= now || b <= now) return a <= now ? a : b;
  return a < b ? a : b;
}

}  // namespace canopen
