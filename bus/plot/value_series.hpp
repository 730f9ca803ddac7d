/// The values of an object over time, in a memory that does not grow with their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edsc {

/// Consecutive values: one, or all in a span of time.
struct ValueBin {
  std::int64_t first_us = 0, last_us = 0;
  double first = 0, min = 0, max = 0, last = 0;
  std::optional<std::int64_t> lost_us = {};  ///< the last value is not known from then on, until the next bin

  /// Appends values that follow.
  void append(const ValueBin& next);
};

/// Up to `max_bins` values are stored as they are. Of more, each span of time of the same length becomes a bin with the
/// first, smallest, largest and last value; the length doubles when there are too many of them.
class ValueSeries {
 public:
  /// Several bins for each pixel of a plot.
  static constexpr std::size_t max_bins = 8192;

  /// `value` must be finite. A time before that of the previous value counts as the same time.
  void add(std::int64_t microseconds, double value);
  /// The last value is not known from a time after it on, until the next one.
  void interrupt(std::int64_t microseconds);

  [[nodiscard]] const std::vector<ValueBin>& bins() const { return bins_; }
  [[nodiscard]] bool empty() const { return bins_.empty(); }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double min() const { return min_; }
  [[nodiscard]] double max() const { return max_; }

 private:
  [[nodiscard]] std::int64_t span_of(std::int64_t microseconds) const;
  void merge();

  std::vector<ValueBin> bins_;
  std::int64_t bin_us_ = 0;  ///< length of the spans; 0: each value is a bin
  std::uint64_t count_ = 0;
  double min_ = 0, max_ = 0;
};

}  // namespace edsc
