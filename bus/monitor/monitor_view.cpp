#include "monitor/monitor_view.hpp"

#include <fmt/format.h>

#include <cmath>

#include "text/counted.hpp"
#include "text/text_table.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* bold = "\x1B[1m";
constexpr const char* red = "\x1B[31m";
constexpr const char* plain = "\x1B[0m";

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json state_or_null(std::optional<canopen::NmtState> state) {
  return state ? Json(canopen::to_text(*state)) : Json(nullptr);
}

double seconds(std::int64_t microseconds) { return static_cast<double>(microseconds) / 1e6; }

/// Percent of the bit rate, without stuff bits.
std::optional<double> load(const MonitorState& state, const MonitorView& view) {
  if (!view.bit_rate) return std::nullopt;
  return state.bits().per_second() / (*view.bit_rate * 10.0);
}

std::string pdo_label(const MonitorState::PdoKey& key) {
  return fmt::format("{} {}", key.transmitted ? "TPDO" : "RPDO", key.number);
}

std::string other_label(std::uint32_t cob_id) {
  return (cob_id & 0x2000'0000) != 0 ? fmt::format("{:08X}h", cob_id & 0x1FFF'FFFF) : fmt::format("{:03X}h", cob_id);
}

/// `operational?`: not by a heartbeat, but by NMT commands or PDOs.
std::string state_text(const MonitoredNode& node) {
  if (node.assumed) return fmt::format("{}?", canopen::to_text(*node.assumed));
  return node.state ? std::string{canopen::to_text(*node.state)} : "-";
}

std::string age_text(const MonitoredNode& node, std::int64_t now_us) {
  if (!node.heard_us) return "-";
  return fmt::format("{:.1f} s{}", seconds(now_us - *node.heard_us), node.is_late(now_us) ? " late" : "");
}

std::string emergency_text(const MonitoredNode& node, std::int64_t now_us) {
  if (node.emergencies == 0) return "-";
  return fmt::format("{} ({} in all, {:.1f} s ago)", node.emergency, node.emergencies,
                     seconds(now_us - node.emergency_us));
}

/// The lines of a table after a bold heading.
void append_table(std::vector<std::string>& lines, const TextTable& table, bool colour) {
  lines.emplace_back();
  const std::vector<std::string> rows = table.lines();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    lines.push_back(colour && i == 0 ? bold + rows[i] + plain : rows[i]);
  }
}

void append_nodes(std::vector<std::string>& lines, const MonitorState& state, const MonitorView& view,
                  std::int64_t now_us) {
  TextTable table;
  table.add({"node", "name", "state", "heard", "last EMCY"});
  for (const auto& [node_id, node] : state.nodes()) {
    table.add({fmt::format("{:>4}", node_id), node.name.empty() ? "-" : node.name, state_text(node),
               age_text(node, now_us), emergency_text(node, now_us)});
  }
  std::size_t row = lines.size() + 2;
  append_table(lines, table, view.colour);
  for (const auto& [node_id, node] : state.nodes()) {
    const bool bad = node.is_late(now_us) || node.error_code != 0;
    if (view.colour && bad) lines[row] = red + lines[row] + plain;
    ++row;
  }
}

void append_pdos(std::vector<std::string>& lines, const MonitorState& state, const MonitorView& view) {
  if (state.pdos().empty()) return;
  TextTable table;
  table.add({"node", "PDO", "per s", "values"});
  for (const auto& [key, pdo] : state.pdos()) {
    table.add(
        {fmt::format("{:>4}", key.node_id), pdo_label(key), fmt::format("{:.1f}", pdo.frames.per_second()), pdo.text});
  }
  append_table(lines, table, view.colour);
}

void append_others(std::vector<std::string>& lines, const MonitorState& state, const MonitorView& view) {
  if (state.others().empty()) return;
  TextTable table;
  table.add({"other CAN-IDs", "per s", "frames"});
  for (const auto& [cob_id, rate] : state.others()) {
    table.add({other_label(cob_id), fmt::format("{:.1f}", rate.per_second()), fmt::format("{}", rate.total())});
  }
  append_table(lines, table, view.colour);
}

}  // namespace

std::vector<std::string> monitor_lines(const MonitorState& state, const MonitorView& view, std::int64_t now_us) {
  std::vector<std::string> lines;
  std::string head = fmt::format("{}  {:.1f} s  {}  {:.1f} per s", view.bus, seconds(now_us - state.start_us()),
                                 counted(state.frames().total(), "frame"), state.frames().per_second());
  if (const auto percent = load(state, view)) head += fmt::format("  load {:.1f} %", *percent);
  lines.push_back(std::move(head));
  append_nodes(lines, state, view, now_us);
  append_pdos(lines, state, view);
  append_others(lines, state, view);
  return lines;
}

std::string cut_to_width(const std::string& line, std::size_t width) {
  std::string out;
  std::size_t shown = 0;
  bool coloured = false;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == '\x1B') {
      const std::size_t end = std::min(line.find('m', at), line.size() - 1) + 1;
      out += line.substr(at, end - at);
      coloured = true;
      at = end;
      continue;
    }
    if (!is_utf8_continuation(line[at]) && ++shown > width) break;
    const auto c = static_cast<unsigned char>(line[at]);
    out += c < 0x20 || c == 0x7F ? '.' : line[at];
    ++at;
  }
  return coloured && !out.ends_with(plain) ? out + plain : out;
}

Json monitor_json(const MonitorState& state, const MonitorView& view, std::int64_t now_us) {
  const auto rounded = [](double number) { return std::round(number * 10) / 10; };
  Json json{{"schema", 2},
            {"duration_us", now_us - state.start_us()},
            {"frames", state.frames().total()},
            {"frames_per_second", rounded(state.frames().per_second())}};
  const auto percent = load(state, view);
  json["load_percent"] = percent ? Json(rounded(*percent)) : Json(nullptr);
  json["nodes"] = Json::array();
  for (const auto& [node_id, node] : state.nodes()) {
    json["nodes"].push_back(
        {{"node_id", node_id},
         {"name", text_or_null(node.name)},
         {"state", state_or_null(node.state)},
         {"assumed_state", state_or_null(node.assumed)},
         {"heartbeats", node.heartbeats},
         {"heard_ago_ms", node.heard_us ? Json((now_us - *node.heard_us) / 1000) : Json(nullptr)},
         {"late", node.is_late(now_us)},
         {"emergencies", node.emergencies},
         {"last_emergency",
          node.emergencies == 0 ? Json(nullptr) : Json{{"code", node.error_code}, {"text", node.emergency}}}});
  }
  json["pdos"] = Json::array();
  for (const auto& [key, pdo] : state.pdos()) {
    Json row{
        {"node_id", key.node_id},       {"direction", key.transmitted ? "transmit" : "receive"}, {"number", key.number},
        {"frames", pdo.frames.total()}, {"per_second", rounded(pdo.frames.per_second())},        {"text", pdo.text},
        {"values", Json::array()}};
    for (const MonitoredValue& value : pdo.values) {
      row["values"].push_back({{"name", value.name}, {"text", value.text}});
    }
    json["pdos"].push_back(std::move(row));
  }
  json["others"] = Json::array();
  for (const auto& [cob_id, rate] : state.others()) {
    json["others"].push_back(
        {{"cob_id", cob_id}, {"frames", rate.total()}, {"per_second", rounded(rate.per_second())}});
  }
  return json;
}

}  // namespace edsc
