/// The times of a log in order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace edsc {

/// A time shortly before an earlier one, as in logs of two interfaces, counts as the same time. After a longer step
/// back, as of a clock that was set or of two logs in one file, the time continues a microsecond later.
class OrderedTime {
 public:
  static constexpr std::int64_t max_disorder_us = 100'000;

  /// Adds the time of a frame, in microseconds. Returns how far it goes back, if that is more than disorder; else 0.
  std::int64_t add(std::int64_t us) {
    if (!first_us_) first_us_ = origin_us_ = us;
    const std::int64_t back = now_us_ - (us - origin_us_);
    if (back > max_disorder_us) origin_us_ = us - (now_us_ + 1);
    now_us_ = std::max(now_us_, us - origin_us_);
    return back > max_disorder_us ? back : 0;
  }

  /// The time of the first frame, as in the log; empty if no frame had a time.
  [[nodiscard]] std::optional<std::int64_t> first_us() const { return first_us_; }
  /// The time of the last frame since the first one; it does not decrease.
  [[nodiscard]] std::int64_t now_us() const { return now_us_; }

 private:
  std::optional<std::int64_t> first_us_;
  std::int64_t origin_us_ = 0, now_us_ = 0;
};

}  // namespace edsc
