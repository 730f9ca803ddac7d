#include "web/monitor_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

LiveRow row_of(std::string key, const Json& json) {
  return {std::move(key), json.dump(-1, ' ', true, Json::error_handler_t::replace)};
}

double rounded(double number) { return std::round(number * 10) / 10; }

std::string_view state_text(std::optional<canopen::NmtState> state) {
  return state ? canopen::to_text(*state) : std::string_view{};
}

Json values_json(const MonitoredPdo& pdo) {
  Json values = Json::array();
  for (const MonitoredValue& value : pdo.values) {
    values.push_back({{"index", value.index},
                      {"sub_index", value.sub_index},
                      {"name", printable(value.name)},
                      {"text", printable(value.text)},
                      {"unit", printable(value.unit)},
                      {"number", value.number ? Json(*value.number) : Json(nullptr)}});
  }
  return values;
}

}  // namespace

std::string monitor_page(const std::string& bus) {
  return render_html(with_parts("monitor.html"), {{"bus", bus},
                                                  {"page_title", "edsc monitor: " + bus},
                                                  {"uplot_style", report_template("uplot.css")},
                                                  {"uplot_script", report_template("uplot.js")},
                                                  {"style", with_parts("monitor.css")},
                                                  {"value_history", report_template("value_history.js")},
                                                  {"keyed_table", report_template("keyed_table.js")},
                                                  {"script", report_template("monitor.js")},
                                                  {"nonce", "{{{nonce}}}"}});
}

bool has_plots() { return !report_template("uplot.js").empty(); }

void EmergencyLog::add(const Message& message, std::int64_t now_us) {
  const std::uint64_t number = count_++;
  new_rows_.push_back(row_of(fmt::format("emcy {}", number), {{"kind", "emcy"},
                                                              {"number", number},
                                                              {"at_us", now_us},
                                                              {"node_id", message.node_id},
                                                              {"code", message.error_code},
                                                              {"text", printable(message.text)}}));
  if (new_rows_.size() > max_rows) new_rows_.pop_front();
}

void EmergencyLog::take(std::vector<LiveRow>& rows, std::vector<std::string>& removed) {
  for (LiveRow& row : new_rows_) rows.push_back(std::move(row));
  new_rows_.clear();
  for (; removed_ + max_rows < count_; ++removed_) removed.push_back(fmt::format("emcy {}", removed_));
}

std::vector<LiveRow> monitor_rows(const MonitorState& state, std::optional<unsigned> bit_rate, std::int64_t now_us) {
  std::vector<LiveRow> rows;
  const double load = bit_rate ? state.bits().per_second() / (*bit_rate * 10.0) : 0;
  rows.push_back(row_of("bus", {{"kind", "bus"},
                                {"at_us", now_us - state.start_us()},
                                {"frames", state.frames().total()},
                                {"per_second", rounded(state.frames().per_second())},
                                {"load_percent", bit_rate ? Json(rounded(load)) : Json(nullptr)}}));
  for (const auto& [node_id, node] : state.nodes()) {
    rows.push_back(row_of(fmt::format("node {}", node_id),
                          {{"kind", "node"},
                           {"node_id", node_id},
                           {"name", printable(node.name)},
                           {"simulated", node.is_simulated},
                           {"state", state_text(node.state)},
                           {"assumed_state", state_text(node.assumed)},
                           {"heard_us", node.heard_us ? Json(*node.heard_us - state.start_us()) : Json(nullptr)},
                           {"late", node.is_late(now_us)},
                           {"emergencies", node.emergencies},
                           {"error_code", node.error_code},
                           {"emergency", printable(node.emergency)}}));
  }
  for (const auto& [key, pdo] : state.pdos()) {
    const char* const direction = key.transmitted ? "TPDO" : "RPDO";
    rows.push_back(row_of(fmt::format("pdo {} {} {}", key.node_id, direction, key.number),
                          {{"kind", "pdo"},
                           {"node_id", key.node_id},
                           {"pdo", fmt::format("{} {}", direction, key.number)},
                           {"at_us", pdo.at_us - state.start_us()},
                           {"per_second", rounded(pdo.frames.per_second())},
                           {"text", printable(pdo.text)},
                           {"values", values_json(pdo)}}));
  }
  for (const auto& [cob_id, rate] : state.others()) {
    rows.push_back(row_of(
        fmt::format("other {}", cob_id),
        {{"kind", "other"}, {"cob_id", cob_id}, {"frames", rate.total()}, {"per_second", rounded(rate.per_second())}}));
  }
  return rows;
}

}  // namespace edsc
