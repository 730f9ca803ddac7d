/// The states of an object over time, in a memory that does not grow with their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edsc {

/// Consecutive values of one state, or several states in a short time.
struct StateRun {
  std::int64_t first_us = 0;                 ///< of the first value; the state remains until the next run
  std::int64_t last_us = 0;                  ///< of the last value
  std::int64_t state = 0;                    ///< the first one of several
  bool is_mixed = false;                     ///< several states
  std::optional<std::int64_t> lost_us = {};  ///< the state is not known from then on, until the next run
};

/// Up to `max_runs` runs are stored as they are. Of more, those that are shorter than a span of time become one with
/// their neighbours; the span doubles until there are few enough.
class StateSeries {
 public:
  static constexpr std::size_t max_runs = 8192;

  /// A time before that of the previous value counts as the same time.
  void add(std::int64_t microseconds, std::int64_t state);
  /// The state is not known from a time after its last value on, until the next one.
  void interrupt(std::int64_t microseconds);

  [[nodiscard]] const std::vector<StateRun>& runs() const { return runs_; }
  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  void combine();
  void merge();

  std::vector<StateRun> runs_;
  std::int64_t span_us_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace edsc
