/// Ticks of an axis: multiples of 1, 2 or 5 times a power of ten.
#pragma once

#include <string>
#include <vector>

namespace edsc {

struct AxisTicks {
  double step = 1;
  std::vector<double> values;

  /// `-0.25`, `1500`, `2e+09`: as many decimals as the step needs.
  [[nodiscard]] std::string text(double value) const;
};

/// At most about `max_count` ticks from `min` to `max`; at least `min_step` apart. `min` must be less than `max`.
[[nodiscard]] AxisTicks axis_ticks(double min, double max, unsigned max_count, double min_step = 0);

}  // namespace edsc
