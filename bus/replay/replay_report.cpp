#include "replay/replay_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/append.hpp"

namespace edsc::replay {
namespace {

using json = nlohmann::ordered_json;

std::string frame_bytes(const canopen::Frame& frame) {
  std::string text;
  append_can_id(text, frame);
  if (frame.size == 0 || frame.remote) return text;
  text += ' ';
  append_hex_bytes(text, data_of(frame));
  return text;
}

/// `node 5 axis1, SDO 1018h:01`
std::string subject_text(const Difference& difference, const NodeLabels& labels) {
  std::string text;
  if (difference.node_id != 0) {
    text = fmt::format("node {}", difference.node_id);
    if (const std::string_view name = labels.name(difference.node_id); !name.empty()) text += fmt::format(" {}", name);
    text += ", ";
  }
  text += row_of(difference.service).label;
  if (difference.entry) {
    text += ' ';
    append_entry_label(text, difference.entry->first, difference.entry->second);
  }
  return text;
}

void append_frame(std::string& text, std::string_view name, const DecodedFrame& shown, std::size_t width) {
  text += fmt::format("    {:<9} {:<{}}  {}", name, frame_bytes(shown.frame), width, printable(shown.text));
  text.erase(text.find_last_not_of(' ') + 1);
  text += '\n';
}

std::string difference_text(const Difference& difference, const Report& report) {
  std::string text = fmt::format("{}:{}: ", printable(report.log), difference.line);
  if (difference.has_time) text += fmt::format("{}.{:06} s: ", difference.us / 1'000'000, difference.us % 1'000'000);
  text += fmt::format("{}: {}\n", printable(subject_text(difference, report.labels)), row_of(difference.kind).meaning);
  std::size_t width = 0;
  for (const auto* const shown : {&difference.request, &difference.expected, &difference.received}) {
    if (*shown) width = std::max(width, frame_bytes((*shown)->frame).size());
  }
  if (difference.request) append_frame(text, "request", *difference.request, width);
  if (difference.expected) {
    append_frame(text, "expected", *difference.expected, width);
  } else {
    text += "    expected  nothing\n";
  }
  if (difference.received) {
    append_frame(text, "received", *difference.received, width);
  } else {
    text += "    received  nothing\n";
  }
  return text;
}

json frame_json(const std::optional<DecodedFrame>& shown) {
  if (!shown) return nullptr;
  std::string data;
  append_hex_bytes(data, data_of(shown->frame), "");
  return {{"can_id", shown->frame.id},
          {"extended", shown->frame.extended},
          {"data", std::move(data)},
          {"text", printable(shown->text)}};
}

json difference_json(const Difference& difference) {
  return {{"kind", row_of(difference.kind).name},
          {"node_id", difference.node_id != 0 ? json(difference.node_id) : json(nullptr)},
          {"service", row_of(difference.service).name},
          {"index",
           difference.entry ? json(entry_label(difference.entry->first, difference.entry->second)) : json(nullptr)},
          {"line", difference.line},
          {"at_us", difference.has_time ? json(difference.us) : json(nullptr)},
          {"request", frame_json(difference.request)},
          {"expected", frame_json(difference.expected)},
          {"received", frame_json(difference.received)}};
}

std::vector<unsigned> node_ids(const NodeSet& nodes) {
  std::vector<unsigned> ids;
  for (unsigned id = 1; id < nodes.size(); ++id) {
    if (nodes[id]) ids.push_back(id);
  }
  return ids;
}

}  // namespace

std::string text_report(const Report& report) {
  std::string text;
  const Result& result = report.result;
  for (const Difference& one : result.differences) text += difference_text(one, report);
  const std::string_view without_difference = result.compared == 0 ? "no result" : "no difference";
  text +=
      fmt::format("{}: {} sent to {}, {} compared: {}\n", printable(report.log), counted(result.sent, "frame"),
                  counted(report.nodes.count(), "node"), counted(result.compared, "response"),
                  result.differences.empty() ? without_difference : counted(result.differences.size(), "difference"));
  return text;
}

std::string json_report(const Report& report) {
  json differences = json::array();
  for (const Difference& one : report.result.differences) differences.push_back(difference_json(one));
  const json document = {{"schema", 2},
                         {"log", printable(report.log)},
                         {"bus", report.bus.empty() ? json(nullptr) : json(printable(report.bus))},
                         {"nodes", node_ids(report.nodes)},
                         {"sent", report.result.sent},
                         {"compared", report.result.compared},
                         {"differences", std::move(differences)}};
  return json_text(document) + '\n';
}

}  // namespace edsc::replay
