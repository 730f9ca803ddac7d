/// Smallest, mean and largest of many times, and their standard deviation, in constant memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace edsc::audit {

/// Times in microseconds. All results are 0 without a time.
class Spread {
 public:
  /// Welford's method: the squares of large times are not summed, so that small deviations keep their digits.
  void add(std::int64_t us) {
    min_ = count_ == 0 ? us : std::min(min_, us);
    max_ = count_ == 0 ? us : std::max(max_, us);
    ++count_;
    const double before = static_cast<double>(us) - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (static_cast<double>(us) - mean_);
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t min() const { return min_; }
  [[nodiscard]] std::int64_t max() const { return max_; }
  [[nodiscard]] std::int64_t jitter() const { return max_ - min_; }
  [[nodiscard]] double mean() const { return mean_; }
  [[nodiscard]] double deviation() const { return count_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(count_)); }

 private:
  std::uint64_t count_ = 0;
  std::int64_t min_ = 0, max_ = 0;
  double mean_ = 0, squares_ = 0;
};

}  // namespace edsc::audit
