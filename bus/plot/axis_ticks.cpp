#include "plot/axis_ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edsc {

AxisTicks axis_ticks(double min, double max, unsigned max_count, double min_step) {
  AxisTicks ticks;
  // Limits whose difference is not a finite number, or too small for their size, have no ticks between them.
  const double wanted = std::max((max / max_count - min / max_count), min_step);
  const double magnitude = std::pow(10.0, std::floor(std::log10(wanted)));
  if (!std::isfinite(magnitude) || magnitude <= 0 || min + magnitude == min || max - magnitude == max) {
    ticks.step = 0;
    ticks.values = {min, max};
    return ticks;
  }
  ticks.step = 10 * magnitude;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * magnitude >= wanted * (1 - 1e-9)) {
      ticks.step = factor * magnitude;
      break;
    }
  }
  constexpr double tolerance = 1e-6;
  const double first = std::ceil(min / ticks.step - tolerance);
  const auto count = static_cast<unsigned>(std::floor(max / ticks.step + tolerance) - first + 1);
  for (unsigned i = 0; i < count; ++i) ticks.values.push_back((first + i) * ticks.step + 0.0);
  return ticks;
}

std::string AxisTicks::text(double value) const {
  constexpr double largest = 1e9, smallest_step = 1e-6;
  if (step < smallest_step || std::abs(value) >= largest) return fmt::format("{:.6g}", value);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace edsc
