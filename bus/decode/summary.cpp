#include "decode/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <iterator>
#include <vector>

#include "decode/print_message.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

std::string abort_text(std::uint32_t code) {
  return fmt::format("{:04X} {:04X}h {}", code >> 16, code & 0xFFFF,
                     canopen::to_text(static_cast<canopen::AbortCode>(code)));
}

/// Whether the node is the sender of the frame.
bool is_of_node(const Message& message) {
  switch (message.service) {
    case Service::boot_up:
    case Service::heartbeat:
    case Service::guarding: return !message.state.empty();
    case Service::emcy:
    case Service::tpdo: return true;
    case Service::sdo: return !message.from_client;
    default: return false;
  }
}

/// `1, 3..8`
std::string ranges_of(const std::vector<std::size_t>& ids) {
  std::string text;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    std::size_t last = i;
    while (last + 1 < ids.size() && ids[last + 1] == ids[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", ids[i]);
    if (last > i + 1) text += fmt::format("..{}", ids[last]);
    if (last == i + 1) text += fmt::format(", {}", ids[last]);
    i = last;
  }
  return text;
}

}  // namespace

/// Whether the node received SDO requests and did not send anything, as most nodes in a scan.
bool Summary::is_silent(std::size_t id) const {
  if (id == 0 || heard_[id]) return false;
  for (const ServiceRow& row : services) {
    const bool asked = row.service == Service::sdo;
    if ((frames_[id][static_cast<std::size_t>(row.service)] > 0) != asked) return false;
  }
  return true;
}

/// One line for all silent nodes, if there are several.
std::string Summary::silent_nodes() const {
  std::vector<std::size_t> ids;
  std::size_t frames = 0, aborted = 0;
  for (std::size_t id = 1; id < node_ids; ++id) {
    if (!is_silent(id)) continue;
    ids.push_back(id);
    frames += frames_[id][static_cast<std::size_t>(Service::sdo)];
    aborted += transfers_[id].aborted;
  }
  if (ids.size() < 2) return {};
  return fmt::format("{} nodes send nothing: {}: SDO {}, {} aborted\n", ids.size(), ranges_of(ids), frames,
                     counted(aborted, "transfer"));
}

void Summary::count_code(Codes& codes, std::uint8_t node_id, std::uint32_t code) {
  const auto at = codes.find({node_id, code});
  if (at != codes.end()) {
    ++at->second;
  } else if (codes.size() < max_codes) {
    codes.emplace(std::pair{node_id, code}, 1);
  }
}

void Summary::add(const LogLine& line, const Message& message) {
  ++frames_in_all_;
  ++frames_[message.node_id % node_ids][static_cast<std::size_t>(message.service)];
  if (is_of_node(message)) heard_[message.node_id % node_ids] = true;
  if (message.problem) ++problems_;
  if (line.has_time) {
    first_us_ = has_time_ ? std::min(first_us_, line.microseconds) : line.microseconds;
    last_us_ = has_time_ ? std::max(last_us_, line.microseconds) : line.microseconds;
    has_time_ = true;
  }
  if (message.service == Service::emcy) count_code(emergencies_, message.node_id, message.error_code);
  Transfers& transfers = transfers_[message.node_id % node_ids];
  if (message.step == TransferStep::aborted) {
    ++transfers.aborted;
    count_code(aborts_, message.node_id, message.abort_code);
  } else if (message.step == TransferStep::finished) {
    ++transfers.finished;
    if (message.duration_us < 0) return;
    const auto duration = static_cast<std::uint64_t>(message.duration_us);
    ++transfers.timed;
    transfers.sum_us += duration;
    transfers.longest_us = std::max(transfers.longest_us, duration);
  }
}

std::size_t Summary::total(std::size_t service) const {
  std::size_t sum = 0;
  for (const auto& node : frames_) sum += node[service];
  return sum;
}

double Summary::seconds() const { return static_cast<double>(last_us_ - first_us_) / 1e6; }

std::string Summary::text() const {
  std::string out;
  const auto put = std::back_inserter(out);
  fmt::format_to(put, "{}", counted(frames_in_all_, "frame"));
  if (has_time_) fmt::format_to(put, " in {:.6f} s", seconds());
  if (has_time_ && seconds() > 0)
    fmt::format_to(put, ", {:.0f} per second", static_cast<double>(frames_in_all_) / seconds());
  out += '\n';
  const auto services_of = [&](const auto& count_of) {
    for (const ServiceRow& row : services) {
      const std::size_t count = count_of(static_cast<std::size_t>(row.service));
      if (count > 0) fmt::format_to(put, "  {} {}", row.service == Service::unknown ? "unknown" : row.label, count);
    }
    out += '\n';
  };
  fmt::format_to(put, "{:<9}", "all");
  services_of([&](std::size_t service) { return total(service); });
  const std::string silent = silent_nodes();
  const auto is_grouped = [&](std::size_t id) { return !silent.empty() && is_silent(id); };
  for (std::size_t id = 1; id < node_ids; ++id) {
    if (is_grouped(id) || std::ranges::all_of(frames_[id], [](std::size_t count) { return count == 0; })) continue;
    fmt::format_to(put, "node {:<4}", id);
    services_of([&](std::size_t service) { return frames_[id][service]; });
  }
  for (std::size_t id = 0; id < node_ids; ++id) {
    const Transfers& one = transfers_[id];
    if (is_grouped(id) || one.finished + one.aborted == 0) continue;
    fmt::format_to(put, "node {:<4}  {}, {} aborted", id, counted(one.finished + one.aborted, "SDO transfer"),
                   one.aborted);
    if (one.timed > 0) {
      fmt::format_to(put, ", {:.3f} ms on average, {:.3f} ms maximum",
                     static_cast<double>(one.sum_us) / 1e3 / static_cast<double>(one.timed),
                     static_cast<double>(one.longest_us) / 1e3);
    }
    out += '\n';
  }
  for (const auto& [key, count] : aborts_)
    if (!is_grouped(key.first))
      fmt::format_to(put, "node {:<4}  abort {}: {}\n", key.first, abort_text(key.second), count);
  for (const auto& [key, count] : emergencies_)
    fmt::format_to(put, "node {:<4}  EMCY {:04X}h: {}\n", key.first, key.second, count);
  out += silent;
  if (open_transfers_ > 0) fmt::format_to(put, "{} not finished\n", counted(open_transfers_, "SDO transfer"));
  if (can_fd_frames_ > 0) fmt::format_to(put, "{} ignored\n", counted(can_fd_frames_, "CAN FD frame"));
  if (broken_lines_ > 0) fmt::format_to(put, "{} skipped\n", counted(broken_lines_, "line"));
  return out;
}

std::string Summary::json() const {
  std::string out;
  const auto put = std::back_inserter(out);
  fmt::format_to(
      put,
      "{{\"summary\":{{\"frames\":{},\"problems\":{},\"open_transfers\":{},\"can_fd_frames\":{},\"broken_lines\":{}",
      frames_in_all_, problems_, open_transfers_, can_fd_frames_, broken_lines_);
  if (has_time_) fmt::format_to(put, ",\"seconds\":{:.6f}", seconds());
  out += ",\"services\":{";
  const auto counts = [&](const auto& count_of) {
    const char* separator = "";
    for (const ServiceRow& row : services) {
      const std::size_t count = count_of(static_cast<std::size_t>(row.service));
      if (count == 0) continue;
      fmt::format_to(put, "{}\"{}\":{}", separator, row.name, count);
      separator = ",";
    }
    out += '}';
  };
  counts([&](std::size_t service) { return total(service); });
  out += ",\"nodes\":[";
  const char* separator = "";
  for (std::size_t id = 1; id < node_ids; ++id) {
    if (std::ranges::all_of(frames_[id], [](std::size_t count) { return count == 0; })) continue;
    const Transfers& one = transfers_[id];
    fmt::format_to(put, "{}{{\"node\":{},\"transfers\":{},\"aborted\":{}", separator, id, one.finished + one.aborted,
                   one.aborted);
    if (one.timed > 0)
      fmt::format_to(put, ",\"average_microseconds\":{},\"longest_microseconds\":{}", one.sum_us / one.timed,
                     one.longest_us);
    out += ",\"services\":{";
    counts([&](std::size_t service) { return frames_[id][service]; });
    out += '}';
    separator = ",";
  }
  const auto codes = [&](std::string_view name, const Codes& rows) {
    fmt::format_to(put, "],\"{}\":[", name);
    const char* between = "";
    for (const auto& [key, count] : rows) {
      fmt::format_to(put, "{}{{\"node\":{},\"code\":{},\"count\":{}}}", between, key.first, key.second, count);
      between = ",";
    }
  };
  codes("aborts", aborts_);
  codes("emergencies", emergencies_);
  out += "]}}\n";
  return out;
}

}  // namespace edsc
