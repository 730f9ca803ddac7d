/// Values over time as an SVG picture.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "plot/state_series.hpp"
#include "plot/value_series.hpp"

namespace edsc {

/// A line of the plot.
struct PlotLine {
  std::string name;    ///< `node 6 Position actual value`
  std::string unit;    ///< may be empty
  std::string panel;   ///< lines with the same text share a value axis
  bool steps = false;  ///< the value remains until the next one; otherwise values are connected
  bool whole = false;  ///< only integers: ticks are at integers
  ValueSeries series;  ///< not empty, except for a band

  bool is_band = false;                             ///< a band of named states in place of a line
  StateSeries states;                               ///< of a band, not empty
  std::map<std::int64_t, std::string> state_names;  ///< of a band; other states have their number

  /// The node is lost at this time: a gap follows, until the next value. Has no effect if a value is newer.
  void interrupt(std::int64_t microseconds) {
    is_band ? states.interrupt(microseconds) : series.interrupt(microseconds);
  }
  [[nodiscard]] bool empty() const { return is_band ? states.empty() : series.empty(); }
};

struct Plot {
  std::string title;
  std::int64_t first_us = 0, last_us = 0;  ///< of the log
  std::vector<PlotLine> lines;
};

/// One panel above the other, with a common time axis, in colours for a light or a dark background. If the times of the
/// log are times of day since 1970, the axis begins at its first frame; otherwise it has the times of the log.
[[nodiscard]] std::string plot_svg(const Plot& plot);

}  // namespace edsc
