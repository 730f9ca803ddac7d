#include "watch/alarm_report.hpp"

#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <nlohmann/json.hpp>

#include "network/cob_id_use.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc::watch {
namespace {

constexpr std::string_view error_color = "\x1b[31m", warning_color = "\x1b[33m", no_color = "\x1b[0m";

std::string seconds(std::int64_t us) { return fmt::format("{}.{:06}", us / 1'000'000, us % 1'000'000); }

std::string can_id_of(const Alarm& alarm) {
  const canopen::CobId cob_id{alarm.cob_id};
  return can_id_text(cob_id.can_id(), cob_id.extended());
}

}  // namespace

std::string alarm_text(const Alarm& alarm, bool color) {
  const Severity severity = alarm.id.row().severity;
  const std::string_view on = severity == Severity::error ? error_color : warning_color;
  std::string text = fmt::format("({})  {}{:<7}{}  {:<18} ", seconds(alarm.us), color ? on : std::string_view{},
                                 to_string(severity), color ? no_color : std::string_view{}, alarm.id.text());
  if (!alarm.node.empty()) text += printable(alarm.node) + ": ";
  text += printable(alarm.text);
  if (alarm.suppressed > 0) text += fmt::format(" ({} since the last one)", counted(alarm.suppressed, "more alarm"));
  return text;
}

std::string alarm_json(const Alarm& alarm) {
  using nlohmann::json;
  nlohmann::ordered_json object{{"schema", 2},
                                {"time_us", alarm.us},
                                {"alarm", alarm.id.text()},
                                {"severity", to_string(alarm.id.row().severity)}};
  object["node_id"] = alarm.node_id != 0 ? nlohmann::ordered_json(alarm.node_id) : nlohmann::ordered_json(nullptr);
  object["node"] = !alarm.node.empty() ? nlohmann::ordered_json(alarm.node) : nlohmann::ordered_json(nullptr);
  object["can_id"] = alarm.has_can_id ? nlohmann::ordered_json(can_id_of(alarm)) : nlohmann::ordered_json(nullptr);
  object["text"] = alarm.text;
  object["suppressed"] = alarm.suppressed;
  return printable_json(object.dump(-1, ' ', false, json::error_handler_t::replace));
}

std::vector<std::string> alarm_variables(const Alarm& alarm) {
  return {fmt::format("EDSC_ALARM={}", alarm.id.text()),
          fmt::format("EDSC_ALARM_SEVERITY={}", to_string(alarm.id.row().severity)),
          fmt::format("EDSC_ALARM_TIME={}", seconds(alarm.us)),
          fmt::format("EDSC_ALARM_NODE={}", alarm.node),
          fmt::format("EDSC_ALARM_NODE_ID={}", alarm.node_id == 0 ? "" : std::to_string(alarm.node_id)),
          fmt::format("EDSC_ALARM_TEXT={}", alarm.text)};
}

}  // namespace edsc::watch
