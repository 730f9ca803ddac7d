/// The time since a start, of which canopen::TimePoint has 71 minutes only.
#pragma once

#include <canopen/base/clock.hpp>
#include <cstdint>

namespace edsc {

class ElapsedTime {
 public:
  explicit ElapsedTime(canopen::TimePoint start) : last_{start} {}

  /// Call at least every half hour. A time before the last one does not change anything. Returns `us()`.
  std::int64_t advance(canopen::TimePoint now) {
    if (now > last_) {
      us_ += (now - last_).count();
      last_ = now;
    }
    return us_;
  }
  [[nodiscard]] std::int64_t us() const { return us_; }

 private:
  canopen::TimePoint last_;
  std::int64_t us_ = 0;
};

}  // namespace edsc
