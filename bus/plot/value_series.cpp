#include "plot/value_series.hpp"

#include <algorithm>

namespace edsc {

void ValueBin::append(const ValueBin& next) {
  last_us = next.last_us;
  min = std::min(min, next.min);
  max = std::max(max, next.max);
  last = next.last;
  lost_us = next.lost_us;
}

/// The number of the span that a time is in.
std::int64_t ValueSeries::span_of(std::int64_t microseconds) const {
  return (microseconds - bins_.front().first_us) / bin_us_;
}

/// Increases the length of the spans until half of the bins suffice.
void ValueSeries::merge() {
  constexpr std::size_t wanted = max_bins / 2;
  do {
    bin_us_ = std::max<std::int64_t>(2 * bin_us_, 1);
  } while (span_of(bins_.back().first_us) >= static_cast<std::int64_t>(wanted));
  std::size_t kept = 0;
  for (std::size_t i = 1; i < bins_.size(); ++i) {
    if (span_of(bins_[i].first_us) == span_of(bins_[kept].first_us)) {
      bins_[kept].append(bins_[i]);
    } else {
      bins_[++kept] = bins_[i];
    }
  }
  bins_.resize(kept + 1);
}

void ValueSeries::add(std::int64_t microseconds, double value) {
  min_ = count_ == 0 ? value : std::min(min_, value);
  max_ = count_ == 0 ? value : std::max(max_, value);
  ++count_;
  if (!bins_.empty()) microseconds = std::max(microseconds, bins_.back().last_us);
  const ValueBin bin{microseconds, microseconds, value, value, value, value, {}};
  if (bin_us_ != 0 && span_of(microseconds) == span_of(bins_.back().first_us)) {
    bins_.back().append(bin);
    return;
  }
  bins_.push_back(bin);
  if (bins_.size() > max_bins) merge();
}

void ValueSeries::interrupt(std::int64_t microseconds) {
  if (!bins_.empty() && microseconds >= bins_.back().last_us) bins_.back().lost_us = microseconds;
}

}  // namespace edsc
