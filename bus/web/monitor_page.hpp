/// The state of the monitor for its page: the page itself, and the rows that it shows.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "decode/message.hpp"
#include "monitor/monitor_state.hpp"
#include "web/live_rows.hpp"

namespace edsc {

/// The page, without a server; it reads `events` beside it.
[[nodiscard]] std::string monitor_page(const std::string& bus);

/// Whether the page has its plots: they need uPlot, which npm brings when edsc is built.
[[nodiscard]] bool has_plots();

/// The EMCYs of the page: the newest.
class EmergencyLog {
 public:
  static constexpr std::size_t max_rows = 200;

  void add(const Message& message, std::int64_t now_us);

  /// The rows since the last call, and the keys of those that are too many.
  void take(std::vector<LiveRow>& rows, std::vector<std::string>& removed);

 private:
  std::deque<LiveRow> new_rows_;
  std::uint64_t count_ = 0;
  std::uint64_t removed_ = 0;
};

/// The rows of the state, with printable texts. Times are in microseconds since its start.
[[nodiscard]] std::vector<LiveRow> monitor_rows(const MonitorState& state, std::optional<unsigned> bit_rate,
                                                std::int64_t now_us);

}  // namespace edsc
