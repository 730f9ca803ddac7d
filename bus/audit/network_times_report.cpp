#include "audit/network_times_report.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "network/cob_id_use.hpp"
#include "text/printable.hpp"
#include "text/text_table.hpp"

namespace edsc::audit {
namespace {

using json = nlohmann::ordered_json;

double us_of(Nanoseconds time) { return static_cast<double>(time.count()) / 1000; }

std::string milliseconds_of(double us) { return fmt::format("{:.3f}", us / 1000); }

std::vector<std::string> message_cells(const MeasuredMessage& one) {
  const CanMessage& message = one.computed.message;
  const bool has_distance = one.distance.count() > 0;
  const auto response = one.response_us();
  const auto is_within = one.is_within_bound();
  const std::string worst = one.computed.response.worst ? milliseconds_of(us_of(*one.computed.response.worst)) : "none";
  return {one.computed.name,
          edsc::can_id_text(message.can_id, message.extended),
          std::to_string(one.frames),
          milliseconds_of(us_of(message.period)) + (one.computed.has_assumed_period ? " assumed" : ""),
          has_distance ? milliseconds_of(static_cast<double>(one.distance.min())) : "",
          has_distance ? milliseconds_of(one.distance.mean()) : "",
          has_distance ? milliseconds_of(static_cast<double>(one.distance.max())) : "",
          response ? milliseconds_of(*response) : "",
          worst,
          milliseconds_of(us_of(deadline_of(message))),
          is_within == false ? "above the bound" : ""};
}

std::vector<std::string> server_cells(const MeasuredServer& one) {
  return {one.name,
          std::to_string(one.response.count()),
          milliseconds_of(static_cast<double>(one.response.min())),
          milliseconds_of(one.response.mean()),
          milliseconds_of(static_cast<double>(one.response.max())),
          milliseconds_of(static_cast<double>(one.timeout_us))};
}

std::string load_text(const NetworkTimes& times, const Totals& totals) {
  return fmt::format("load: {}.{} % measured, at most {}.{} % over 100 ms; {:.1f} to {:.1f} % computed",
                     totals.mean_load / 10, totals.mean_load % 10, totals.max_load / 10, totals.max_load % 10,
                     times.computed_load().min * 100, times.computed_load().max * 100);
}

json spread_of(const Spread& spread) {
  if (spread.count() == 0) return nullptr;
  return {{"count", spread.count()}, {"min_us", spread.min()},       {"mean_us", spread.mean()},
          {"max_us", spread.max()},  {"jitter_us", spread.jitter()}, {"deviation_us", spread.deviation()}};
}

template <class Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

}  // namespace

std::string network_text(const NetworkTimes& times, const Totals& totals) {
  std::string text = load_text(times, totals) + "\n\n";
  TextTable messages{1};
  messages.add(
      {"times in ms", "CAN-ID", "frames", "period", "min", "mean", "max", "response", "bound", "deadline", ""});
  for (const MeasuredMessage& one : times.messages()) {
    if (one.computed.service != FrameService::sdo) messages.add(message_cells(one));
  }
  for (const std::string& line : messages.lines()) text += printable(line) + '\n';
  TextTable servers{1};
  servers.add({"SDO responses in ms", "count", "min", "mean", "max", "timeout"});
  bool has_server = false;
  for (const MeasuredServer& one : times.servers()) {
    if (one.response.count() == 0) continue;
    servers.add(server_cells(one));
    has_server = true;
  }
  if (!has_server) return text;
  text += '\n';
  for (const std::string& line : servers.lines()) text += printable(line) + '\n';
  return text;
}

json network_json(const NetworkTimes& times, const Totals& totals) {
  json messages = json::array();
  for (const MeasuredMessage& one : times.messages()) {
    if (one.computed.service == FrameService::sdo) continue;
    const auto& worst = one.computed.response.worst;
    messages.push_back({{"name", printable(one.computed.name)},
                        {"can_id", one.computed.message.can_id},
                        {"frames", one.frames},
                        {"period_us", us_of(one.computed.message.period)},
                        {"has_assumed_period", one.computed.has_assumed_period},
                        {"distance", spread_of(one.distance)},
                        {"after_sync", spread_of(one.after_sync)},
                        {"response_us", or_null(one.response_us())},
                        {"worst_us", worst ? json(us_of(*worst)) : json(nullptr)},
                        {"deadline_us", us_of(deadline_of(one.computed.message))},
                        {"within_bound", or_null(one.is_within_bound())}});
  }
  json servers = json::array();
  for (const MeasuredServer& one : times.servers()) {
    servers.push_back({{"node_id", one.node_id},
                       {"name", printable(one.name)},
                       {"response", spread_of(one.response)},
                       {"timeout_us", one.timeout_us}});
  }
  return {{"load_percent",
           {{"mean", static_cast<double>(totals.mean_load) / 10},
            {"max", static_cast<double>(totals.max_load) / 10},
            {"computed_min", times.computed_load().min * 100},
            {"computed_max", times.computed_load().max * 100}}},
          {"messages", std::move(messages)},
          {"sdo", std::move(servers)}};
}

json network_view(const NetworkTimes& times, const Totals& totals) {
  json messages = json::array();
  for (const MeasuredMessage& one : times.messages()) {
    if (one.computed.service == FrameService::sdo) continue;
    const std::vector<std::string> cells = message_cells(one);
    messages.push_back({{"name", cells[0]},
                        {"can_id", cells[1]},
                        {"frames", cells[2]},
                        {"period", cells[3]},
                        {"min", cells[4]},
                        {"mean", cells[5]},
                        {"max", cells[6]},
                        {"response", cells[7]},
                        {"bound", cells[8]},
                        {"deadline", cells[9]},
                        {"verdict", cells[10]}});
  }
  json servers = json::array();
  for (const MeasuredServer& one : times.servers()) {
    if (one.response.count() == 0) continue;
    const std::vector<std::string> cells = server_cells(one);
    servers.push_back({{"name", cells[0]},
                       {"count", cells[1]},
                       {"min", cells[2]},
                       {"mean", cells[3]},
                       {"max", cells[4]},
                       {"timeout", cells[5]}});
  }
  const bool has_servers = !servers.empty();
  return {{"load", load_text(times, totals)},
          {"messages", std::move(messages)},
          {"has_servers", has_servers},
          {"servers", std::move(servers)}};
}

}  // namespace edsc::audit
