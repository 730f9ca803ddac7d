/// Cycle times as text, JSON and rows of a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "audit/cycle_times.hpp"
#include "decode/log/print_message.hpp"

namespace edsc::audit {

/// A table with times in milliseconds.
[[nodiscard]] std::string cycles_text(const CycleTimes& times, const NodeLabels& labels);
/// `cycles` of docs/schema/audit.schema.json.
[[nodiscard]] nlohmann::ordered_json cycles_json(const CycleTimes& times, const NodeLabels& labels);
/// The rows of the page: the texts of the table.
[[nodiscard]] nlohmann::ordered_json cycles_rows(const CycleTimes& times, const NodeLabels& labels);

}  // namespace edsc::audit
