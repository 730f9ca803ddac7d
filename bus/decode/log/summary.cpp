#include "decode/log/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "text/counted.hpp"
#include "values/append.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

/// `1, 3..8`
std::string ranges_of(const std::vector<std::size_t>& ids) {
  std::string text;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", ids[i]);
    if (last > i) text += fmt::format("{}{}", last == i + 1 ? ", " : "..", ids[last]);
    i = last;
  }
  return text;
}

bool is_empty(const ServiceCounts& counts) {
  return std::ranges::all_of(counts, [](std::size_t count) { return count == 0; });
}

/// `  SDO 4  TPDO 2`
void append_services(std::string& out, const ServiceCounts& counts) {
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const ServiceRow& row = services[i];
    if (counts[i] == 0) continue;
    fmt::format_to(std::back_inserter(out), "  {} {}", row.service == Service::unknown ? "unknown" : row.label,
                   counts[i]);
  }
  out += '\n';
}

Json services_json(const ServiceCounts& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] != 0) json[std::string{services[i].name}] = counts[i];
  }
  return json;
}

Json codes_json(const CodeCounts& codes) {
  Json json = Json::array();
  for (const auto& [key, count] : codes) {
    json.push_back({{"node", key.first}, {"code", key.second}, {"count", count}});
  }
  return json;
}

}  // namespace

/// Whether the node received SDO requests and did not send anything, as most nodes in a scan.
bool Summary::is_silent(std::size_t id) const {
  ServiceCounts others = nodes_[id].frames;
  const std::size_t requests = std::exchange(others[static_cast<std::size_t>(Service::sdo)], 0);
  return id != 0 && !nodes_[id].sends && requests != 0 && is_empty(others);
}

/// One line for all silent nodes, if there are several.
std::string Summary::silent_nodes() const {
  std::vector<std::size_t> ids;
  std::size_t frames = 0, aborted = 0;
  for (std::size_t id = 1; id < node_ids; ++id) {
    if (!is_silent(id)) continue;
    ids.push_back(id);
    frames += nodes_[id].frames[static_cast<std::size_t>(Service::sdo)];
    aborted += nodes_[id].aborted;
  }
  if (ids.size() < 2) return {};
  return fmt::format("{} nodes send nothing: {}: SDO {}, {} aborted\n", ids.size(), ranges_of(ids), frames,
                     counted(aborted, "transfer"));
}

void Summary::count_code(CodeCounts& codes, std::uint8_t node_id, std::uint32_t code) {
  const std::pair key{node_id, code};
  if (codes.size() < max_codes || codes.contains(key)) ++codes[key];
}

void Summary::add(const LogLine& line, const Message& message) {
  Node& node = nodes_[message.node_id % node_ids];
  ++frames_;
  ++node.frames[static_cast<std::size_t>(message.service)];
  if (is_from_node(message)) node.sends = true;
  if (message.problem) ++problems_;
  if (line.has_time) {
    last_us_ = first_us_ ? std::max(last_us_, line.microseconds) : line.microseconds;
    first_us_ = std::min(first_us_.value_or(line.microseconds), line.microseconds);
  }
  if (message.service == Service::emcy) count_code(emergencies_, message.node_id, message.error_code);
  if (message.step == TransferStep::aborted) {
    ++node.aborted;
    count_code(aborts_, message.node_id, message.abort_code);
  } else if (message.step == TransferStep::finished) {
    ++node.finished;
    if (message.duration_us < 0) return;
    const auto duration = static_cast<std::uint64_t>(message.duration_us);
    ++node.timed;
    node.sum_us += duration;
    node.longest_us = std::max(node.longest_us, duration);
  }
}

ServiceCounts Summary::all_frames() const {
  ServiceCounts sum{};
  for (const Node& node : nodes_) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += node.frames[i];
  }
  return sum;
}

std::string Summary::text() const {
  std::string out = counted(frames_, "frame");
  const auto put = std::back_inserter(out);
  if (first_us_) fmt::format_to(put, " in {:.6f} s", seconds());
  if (first_us_ && seconds() > 0) fmt::format_to(put, ", {:.0f} per second", static_cast<double>(frames_) / seconds());
  fmt::format_to(put, "\n{:<9}", "all");
  append_services(out, all_frames());
  const std::string silent = silent_nodes();
  const auto is_grouped = [&](std::size_t id) { return !silent.empty() && is_silent(id); };
  for (std::size_t id = 1; id < node_ids; ++id) {
    if (is_grouped(id) || is_empty(nodes_[id].frames)) continue;
    fmt::format_to(put, "node {:<4}", id);
    append_services(out, nodes_[id].frames);
  }
  for (std::size_t id = 0; id < node_ids; ++id) {
    const Node& node = nodes_[id];
    if (is_grouped(id) || node.transfers() == 0) continue;
    fmt::format_to(put, "node {:<4}  {}, {} aborted", id, counted(node.transfers(), "SDO transfer"), node.aborted);
    if (node.timed > 0) {
      fmt::format_to(put, ", {:.3f} ms on average, {:.3f} ms maximum",
                     static_cast<double>(node.sum_us) / 1e3 / static_cast<double>(node.timed),
                     static_cast<double>(node.longest_us) / 1e3);
    }
    out += '\n';
  }
  for (const auto& [key, count] : aborts_) {
    if (is_grouped(key.first)) continue;
    fmt::format_to(put, "node {:<4}  abort ", key.first);
    append_abort(out, key.second);
    fmt::format_to(put, ": {}\n", count);
  }
  for (const auto& [key, count] : emergencies_) {
    fmt::format_to(put, "node {:<4}  EMCY {:04X}h: {}\n", key.first, key.second, count);
  }
  out += silent;
  if (open_transfers_ > 0) fmt::format_to(put, "{} not finished\n", counted(open_transfers_, "SDO transfer"));
  if (can_fd_frames_ > 0) fmt::format_to(put, "{} ignored\n", counted(can_fd_frames_, "CAN FD frame"));
  if (broken_lines_ > 0) fmt::format_to(put, "{} skipped\n", counted(broken_lines_, "line"));
  return out;
}

std::string Summary::json() const {
  Json json{{"frames", frames_},
            {"problems", problems_},
            {"open_transfers", open_transfers_},
            {"can_fd_frames", can_fd_frames_},
            {"broken_lines", broken_lines_}};
  if (first_us_) json["duration_us"] = last_us_ - *first_us_;
  json["services"] = services_json(all_frames());
  json["nodes"] = Json::array();
  for (std::size_t id = 1; id < node_ids; ++id) {
    const Node& node = nodes_[id];
    if (is_empty(node.frames)) continue;
    Json row{{"node", id}, {"transfers", node.transfers()}, {"aborted", node.aborted}};
    if (node.timed > 0) {
      row["average_us"] = node.sum_us / node.timed;
      row["longest_us"] = node.longest_us;
    }
    row["services"] = services_json(node.frames);
    json["nodes"].push_back(std::move(row));
  }
  json["aborts"] = codes_json(aborts_);
  json["emergencies"] = codes_json(emergencies_);
  return Json{{"schema", 2}, {"summary", std::move(json)}}.dump() + '\n';
}

}  // namespace edsc
