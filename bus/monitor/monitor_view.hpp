/// What the monitor has seen, as lines of a table and as JSON.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "monitor/monitor_state.hpp"

namespace edsc {

struct MonitorView {
  std::string bus;
  std::optional<unsigned> bit_rate;  ///< kbit/s, for the load
  bool colour = false;
};

/// The table; no line is limited in width.
[[nodiscard]] std::vector<std::string> monitor_lines(const MonitorState& state, const MonitorView& view,
                                                     std::int64_t now_us);

/// A line cut to so many characters; colours count nothing and are switched off at its end.
[[nodiscard]] std::string cut_to_width(const std::string& line, std::size_t width);

/// As docs/schema/monitor.schema.json says.
[[nodiscard]] nlohmann::ordered_json monitor_json(const MonitorState& state, const MonitorView& view,
                                                  std::int64_t now_us);

}  // namespace edsc
