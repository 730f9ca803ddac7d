#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "decode/log/ordered_time.hpp"
#include "device/load_sheet.hpp"
#include "lookup/find_entry.hpp"
#include "replay/node_port.hpp"
#include "replay/replay_report.hpp"
#include "shared/arguments.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_options.hpp"
#include "shared/log_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc replay trace.log --node 5=drive.eds                     to a simulated node, in simulated time
  edsc replay trace.log --node 5=drive.eds --all-differences --ignore 1018h:04
  edsc replay trace.log socketcan:can0                         to the nodes of a bus, with the timing of the log
  edsc replay trace.asc socketcan:can0 --node 5=drive.eds --pdos --speed 200
  edsc replay trace.log --network plant.json --format json     for a program; exit code 1 if there is a difference)";

struct Settings : LogSettings {
  std::string target;
  std::vector<std::string> ignored;
  bool pdos = false;
  bool all_differences = false;
  unsigned timeout_ms = 1000;
  unsigned speed = 100;
  std::string format = "text";

  /// LOG and the bus may have either order.
  void resolve() {
    if (is_bus_address(log)) std::swap(log, target);
    if (log.empty()) throw_required("LOG");
    if (!target.empty() && !is_bus_address(target)) {
      throw_invalid("TARGET", "\"" + target + "\" is not the address of a bus, such as socketcan:can0");
    }
    if (target.empty() && !describe_nodes()) throw_required("TARGET, a bus, or --node ID=FILE or --network FILE");
  }
};

/// The entries that a text names: by address, or by the name in one of the EDS files.
EntryAddress find_ignored(const std::string& text, const GivenNodes& nodes) {
  if (const auto address = parse_entry_address(text)) return *address;
  for (const auto& [node_id, node] : nodes.devices) {
    const FoundEntry found = find_entry(node.named, text);
    if (!found.ok()) continue;
    const bool is_whole = found.entry == nullptr;
    return {found.object->index, is_whole ? std::nullopt : std::optional{found.entry->sub_index}};
  }
  fail(fmt::format("--ignore: \"{}\" is neither an address such as 1018h:04 nor an object of a given EDS",
                   printable(text)));
}

struct RecordedLog {
  std::vector<replay::RecordedFrame> frames;
  bool has_broken_lines = false;
};

/// The frames of the log. Lines that are not frames are reported.
RecordedLog read_recorded(const Settings& settings, const GivenNodes& nodes) {
  LogDecoder decoder{{}, nodes.labels, {settings.log_name(), settings.interface, LogOutput::text, false, {}}};
  RecordedLog recorded;
  std::vector<replay::RecordedFrame>& frames = recorded.frames;
  OrderedTime time;
  std::int64_t at_us = 0, skipped_us = 0;
  std::string complaints;
  const auto print_complaints = [&] {
    write_to_stderr(complaints);
    complaints.clear();
  };
  const auto use = [&](LogLine& line) {
    constexpr std::int64_t without_time_us = 1000, second_us = 1'000'000;
    if (decoder.evaluate(line, complaints) == nullptr || line.kind != LogLineKind::frame) return;
    if (line.has_time) {
      static_cast<void>(time.add(line.microseconds));
      at_us = time.now_us();
    } else if (!frames.empty()) {
      at_us += without_time_us;
    }
    if (const std::int64_t gap_us = frames.empty() ? 0 : at_us - frames.back().us; gap_us > replay::max_gap_us) {
      skipped_us += gap_us - replay::max_gap_us;
      complaints += fmt::format("edsc: {}:{}: {} s: no frame for {} s before this one; the replay takes {} s for it\n",
                                printable(settings.log_name()), line.number, at_us / second_us, gap_us / second_us,
                                replay::max_gap_us / second_us);
    }
    frames.push_back({line.frame, line.number, line.has_time, at_us, skipped_us});
  };
  const auto fail_if_unreadable = read_log(settings, use, print_complaints);
  print_complaints();
  fail_if_unreadable();
  if (frames.empty()) fail(settings.log_name() + ": the log has no frames", exit_input_has_errors);
  recorded.has_broken_lines = decoder.skipped_lines();
  return recorded;
}

/// The nodes that are compared: those of --node, else those that answer in the log.
replay::NodeSet nodes_of(const Settings& settings, const GivenNodes& given,
                         const std::vector<replay::RecordedFrame>& frames) {
  replay::NodeSet nodes;
  if (!settings.nodes.empty()) {
    for (const std::uint8_t node_id : given.of_node_options) nodes.set(node_id);
    return nodes;
  }
  nodes = replay::answering_nodes(frames);
  if (settings.target.empty()) {
    for (std::size_t node_id = 1; node_id < nodes.size(); ++node_id) {
      if (!given.devices.contains(static_cast<std::uint8_t>(node_id))) nodes.reset(node_id);
    }
  }
  if (nodes.none()) {
    fail(fmt::format("{}: no node{} answers SDO requests; state the nodes with --node ID=FILE", settings.log_name(),
                     settings.target.empty() ? " of the network file" : ""),
         exit_input_has_errors);
  }
  return nodes;
}

std::unique_ptr<replay::NodePort> simulated_nodes(const GivenNodes& given, const replay::NodeSet& nodes) {
  auto port = std::make_unique<replay::NodePort>();
  for (const auto& [node_id, node] : given.devices) {
    if (!nodes[node_id]) continue;
    LoadedSheet made = load_sheet(node.named.device, *node.options);
    for (const std::string& note : made.notes) print_to_stderr("edsc: node {}: {}\n", node_id, note);
    if (!made.sheet) throw Exit{exit_input_has_errors};
    port->add(node_id, std::move(made.sheet));
  }
  return port;
}

/// ` 5, 9`
std::string id_list(const replay::NodeSet& nodes) {
  std::string text;
  for (std::size_t node_id = 1; node_id < nodes.size(); ++node_id) {
    if (nodes[node_id]) text += fmt::format("{} {}", text.empty() ? "" : ",", node_id);
  }
  return text;
}

/// A result without a comparison says nothing about the nodes.
void report_nothing_compared(const Settings& settings, const replay::NodeSet& compared,
                             const replay::NodeSet& sending) {
  const auto label = [](const replay::NodeSet& nodes) { return nodes.count() == 1 ? "node" : "nodes"; };
  print_to_stderr("edsc: {}: nothing was compared with {}{}; {}\n", settings.log_name(), label(compared),
                  id_list(compared),
                  sending.none() ? "no node sends frames in the log"
                                 : fmt::format("the log has frames of {}{}", label(sending), id_list(sending)));
}

int replay_log(const Settings& settings) {
  const GivenNodes given = load_given_nodes(settings, settings.color);
  const RecordedLog recorded = read_recorded(settings, given);
  const std::vector<replay::RecordedFrame>& frames = recorded.frames;
  replay::Settings how;
  how.nodes = nodes_of(settings, given, frames);
  for (const std::string& text : settings.ignored) how.ignored.push_back(find_ignored(text, given));
  how.pdos = settings.pdos;
  how.all_differences = settings.all_differences;
  how.timeout_us = std::int64_t{settings.timeout_ms} * 1000;
  how.speed = settings.target.empty() ? 100 : settings.speed;
  const auto run = [&](LiveBus& bus) {
    const replay::Result result = replay::replay(bus, frames, given.known(), how);
    const replay::Report report{settings.log_name(), settings.target, how.nodes, given.labels, result};
    write_output(settings.format == "json" ? json_report(report) : text_report(report));
    const bool has_compared = result.compared != 0 || !result.differences.empty();
    if (!has_compared) report_nothing_compared(settings, how.nodes, replay::sending_nodes(frames));
    return has_compared && result.differences.empty() && !recorded.has_broken_lines ? exit_fine : exit_input_has_errors;
  };
  if (!settings.target.empty()) return with_bus(settings.target, run);
  auto port = simulated_nodes(given, how.nodes);
  how.power_on = [&nodes = *port](std::uint8_t node_id) { nodes.power_on(node_id); };
  return with_bus(std::move(port), "simulated nodes", run);
}

}  // namespace

void add_replay_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, replay_log, exit_code);
  settings.log.clear();
  add_log_options(command, settings);
  command.add_option("TARGET", settings.target, "bus of the nodes, such as socketcan:can0 (default: simulated nodes)");
  command.add_option("--ignore", settings.ignored).one_value_each();
  command.add_flag("--pdos", settings.pdos);
  command.add_flag("--all-differences", settings.all_differences);
  command.add_milliseconds("--timeout", settings.timeout_ms, 1, 3'600'000, "to a request of the log");
  command.add_option("--speed", settings.speed, "on a bus; simulated nodes do not wait")
      .range(1, 100'000)
      .show_default();
  add_format_option(command, settings.format);
}

}  // namespace edsc
