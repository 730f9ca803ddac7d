/// The measured times of a network as text, JSON and rows of a page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "audit/auditor.hpp"
#include "audit/network_times.hpp"

namespace edsc::audit {

/// The load, and a table with times in milliseconds.
[[nodiscard]] std::string network_text(const NetworkTimes& times, const Totals& totals);
/// `network` of docs/schema/audit.schema.json.
[[nodiscard]] nlohmann::ordered_json network_json(const NetworkTimes& times, const Totals& totals);
/// `load`, and the cells of the tables of the page.
[[nodiscard]] nlohmann::ordered_json network_view(const NetworkTimes& times, const Totals& totals);

}  // namespace edsc::audit
