/// The rate of frames, with room for a few that come together.
#pragma once

#include <algorithm>
#include <cstdint>

namespace edsc::watch {

/// Each frame takes its period from an account that is filled at 125 % of the time that passes, up to `burst` periods.
class FrameRate {
 public:
  static constexpr std::int64_t burst = 10;

  void restart() { is_running_ = false; }

  /// Counts a frame. Returns whether it is one too many; the account is then full again, so that each further alarm
  /// is about further frames.
  [[nodiscard]] bool exceeds(std::int64_t us, std::int64_t period_us) {
    const std::int64_t full = burst * period_us;
    if (!is_running_) {
      is_running_ = true;
      left_us_ = full;
    } else {
      // Longer times fill the account anyway.
      const std::int64_t passed = std::min(us - last_us_, full);
      left_us_ = std::min(full, left_us_ + passed + passed / 4);
    }
    last_us_ = us;
    left_us_ -= period_us;
    if (left_us_ >= 0) return false;
    left_us_ = full;
    return true;
  }

 private:
  bool is_running_ = false;
  std::int64_t last_us_ = 0, left_us_ = 0;
};

}  // namespace edsc::watch
