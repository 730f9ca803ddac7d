/// The state of the monitor as lines of a table and as JSON.
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

/// The table, with lines of any width.
[[nodiscard]] std::vector<std::string> monitor_lines(const MonitorState& state, const MonitorView& view,
                                                     std::int64_t now_us);

/// A line truncated to this number of characters, not counting colours, which are reset at its end.
[[nodiscard]] std::string cut_to_width(const std::string& line, std::size_t width);

/// By docs/schema/monitor.schema.json.
[[nodiscard]] nlohmann::ordered_json monitor_json(const MonitorState& state, const MonitorView& view,
                                                  std::int64_t now_us);

}  // namespace edsc
