#include "plot/state_series.hpp"

#include <algorithm>

namespace edsc {

void StateSeries::add(std::int64_t microseconds, std::int64_t state) {
  ++count_;
  if (!runs_.empty()) {
    StateRun& last = runs_.back();
    microseconds = std::max(microseconds, last.last_us);
    if (!last.lost_us) last.last_us = microseconds;
    if (last.state == state && !last.is_mixed && !last.lost_us) return;
  }
  runs_.push_back({microseconds, microseconds, state, false, {}});
  if (runs_.size() > max_runs) merge();
}

void StateSeries::interrupt(std::int64_t microseconds) {
  if (!runs_.empty() && microseconds >= runs_.back().last_us) runs_.back().lost_us = microseconds;
}

/// Combines runs that are shorter than the span. The last run is kept: its end is not known.
void StateSeries::combine() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 1 < runs_.size(); ++i) {
    StateRun run = runs_[i];
    const bool is_short = run.is_mixed || runs_[i + 1].first_us - run.first_us < span_us_;
    if (is_short && kept > 0 && runs_[kept - 1].is_mixed) {
      runs_[kept - 1].last_us = run.last_us;
      runs_[kept - 1].lost_us = run.lost_us;
      continue;
    }
    run.is_mixed = is_short;
    runs_[kept++] = run;
  }
  runs_[kept++] = runs_.back();
  runs_.resize(kept);
}

/// Increases the span only if half of the runs do not suffice with the present one.
void StateSeries::merge() {
  constexpr std::size_t wanted = max_runs / 2;
  combine();
  while (runs_.size() > wanted) {
    span_us_ = std::max<std::int64_t>(2 * span_us_, 1);
    combine();
  }
}

}  // namespace edsc
