/// The result of a replay as text and as JSON (docs/schema/replay.schema.json).
#pragma once

#include <string>

#include "decode/log/print_message.hpp"
#include "replay/replay.hpp"

namespace edsc::replay {

struct Report {
  std::string log;
  std::string bus;  ///< empty: simulated nodes
  NodeSet nodes;
  const NodeLabels& labels;
  const Result& result;
};

/// Each difference with its frames, then one line with the totals.
[[nodiscard]] std::string text_report(const Report& report);
[[nodiscard]] std::string json_report(const Report& report);

}  // namespace edsc::replay
