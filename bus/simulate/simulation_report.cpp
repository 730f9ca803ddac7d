#include "simulate/simulation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "device/device.hpp"
#include "network/error_control.hpp"
#include "text/counted.hpp"
#include "text/text_table.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;
using Condition = SimulatedNodeEnd::Condition;
using Kind = SimulationEvent::Kind;

std::string milliseconds_of(std::uint64_t us) { return fmt::format("{:.3f}", static_cast<double>(us) / 1e3); }

/// `10.000 s`, with the sign of a time before the start of the nodes.
std::string seconds_of(std::int64_t us) { return fmt::format("{:.3f} s", static_cast<double>(us) / 1e6); }

std::uint64_t in_microseconds(Nanoseconds time) { return static_cast<std::uint64_t>(time.count() / 1000); }

/// Whole microseconds of a bound, rounded up.
std::optional<std::uint64_t> bound_of(const TimedMessage& message) {
  if (!message.response.worst) return std::nullopt;
  return in_microseconds(*message.response.worst + Nanoseconds{999});
}

double load_of(std::uint64_t busy_us, std::uint64_t measured_us) {
  return measured_us == 0 ? 0 : 100.0 * static_cast<double>(busy_us) / static_cast<double>(measured_us);
}

double busiest_load(const SimulationResult& result) {
  return load_of(result.busiest_us, std::min<std::uint64_t>(result.measured_us, 1'000'000));
}

/// Whether the bounds do not hold: a node is missing or sends what the network file does not know.
bool has_node_fault(const std::vector<SimulationFault>& faults) {
  return std::ranges::any_of(faults, [](const SimulationFault& one) { return one.kind != FaultKind::errors; });
}

bool is_faulty(const std::vector<SimulationFault>& faults, std::size_t node) {
  return std::ranges::any_of(
      faults, [&](const SimulationFault& one) { return one.kind != FaultKind::errors && one.node == node; });
}

/// Events of a message without a frame. One may be waiting at the end.
std::uint64_t lost_values(const SimulationResult& result, std::size_t message) {
  const auto& changes = result.changes[message];
  const std::uint64_t sent = result.messages[message].count + 1;
  return changes && *changes > sent ? *changes - sent : 0;
}

const NetworkNode& node_of(const SimulatedNetwork& simulated, std::size_t place) {
  return simulated.network.nodes[place];
}

/// The name of the node with this node-ID.
std::string node_with_id(const SimulatedNetwork& simulated, unsigned node_id) {
  const auto& nodes = simulated.network.nodes;
  const auto at = std::ranges::find(nodes, node_id, &NetworkNode::node_id);
  return at != nodes.end() ? at->name : fmt::format("node {}", node_id);
}

/// The NMT master sends the SDO requests and NMT commands.
std::string sender_of(const SimulatedNetwork& simulated, const OtherFrames& frames) {
  if (frames.node) return node_of(simulated, *frames.node).name;
  const NetworkNode* const master = simulated.network.master();
  return master != nullptr ? master->name : "master";
}

std::string condition_text(const SimulatedNodeEnd& end) {
  switch (end.condition) {
    case Condition::off: return "off";
    case Condition::running: return std::string{nmt_state_text(end.state)};
    case Condition::lost: return "lost";
    case Condition::babbling: return "babbling";
  }
  return {};
}

std::string event_text(const SimulatedNetwork& simulated, const SimulationEvent& event) {
  const std::string& name = node_of(simulated, event.node).name;
  switch (event.kind) {
    case Kind::emergency:
      return fmt::format("{} reports EMCY {:04X}h, error register {:02X}h", name, event.code, event.error_register);
    case Kind::heartbeat_lost: return fmt::format("{} misses {}", name, node_with_id(simulated, event.other));
    case Kind::heartbeat_back: return fmt::format("{} hears {} again", name, node_with_id(simulated, event.other));
    case Kind::state: return fmt::format("{} is {}", name, nmt_state_text(event.state));
  }
  return {};
}

bool has_babbling_node(const std::vector<SimulationFault>& faults) {
  return std::ranges::any_of(faults, [](const SimulationFault& one) { return one.kind == FaultKind::babbling; });
}

/// A lost node that no other node misses, and missing heartbeats of nodes that are not lost. A node with guarding in
/// place of a heartbeat has no consumer in the simulation; a babbling node delays the heartbeats of all others.
void add_problems_of_losses(const SimulatedNetwork& simulated, std::vector<std::string>& problems) {
  const auto& nodes = simulated.network.nodes;
  const auto& events = simulated.result.events;
  for (const SimulationFault& fault : simulated.faults) {
    if (fault.kind != FaultKind::lost) continue;
    const NetworkNode& node = nodes[fault.node];
    if (heartbeat_time(node.device()) == 0 && node_guarding(node.device())) continue;
    const bool is_missed = std::ranges::any_of(events, [&](const SimulationEvent& event) {
      return event.kind == Kind::heartbeat_lost && event.other == node.node_id;
    });
    if (!is_missed) problems.push_back(fmt::format("no node detects that {} is lost", node.name));
  }
  if (has_babbling_node(simulated.faults)) return;
  for (const SimulationEvent& event : events) {
    if (event.kind != Kind::heartbeat_lost) continue;
    const auto missed = std::ranges::find(nodes, event.other, &NetworkNode::node_id);
    if (missed == nodes.end() || is_faulty(simulated.faults, static_cast<std::size_t>(missed - nodes.begin())))
      continue;
    if (is_faulty(simulated.faults, event.node)) continue;  // a lost node receives nothing
    problems.push_back(
        fmt::format("{}: {}, which has no fault", seconds_of(event.time_us), event_text(simulated, event)));
  }
}

/// Boot-up and start are not shown: all nodes do that.
bool is_shown(const SimulationEvent& event) {
  constexpr std::int64_t start_us = 1'000'000;
  if (event.kind != Kind::state) return true;
  return event.time_us > start_us || (event.time_us >= 0 && event.state != canopen::NmtState::operational);
}

void add_frames(const SimulatedNetwork& simulated, std::vector<std::string>& lines) {
  TextTable table;
  table.add({"CAN-ID", "frame", "count", "worst ms", "bound ms", "at", ""});
  const auto add = [&](std::string can_id, std::string name, const SeenFrames& seen,
                       std::optional<std::uint64_t> bound) {
    const bool exceeds = bound && seen.worst_us > *bound && !has_node_fault(simulated.faults);
    table.add({std::move(can_id), std::move(name), std::to_string(seen.count),
               seen.count == 0 ? "-" : milliseconds_of(seen.worst_us), bound ? milliseconds_of(*bound) : "-",
               seen.count == 0 ? "-" : seconds_of(static_cast<std::int64_t>(seen.at_us)), exceeds ? "exceeded" : ""});
  };
  for (std::size_t i = 0; i < simulated.timing.messages.size(); ++i) {
    const TimedMessage& one = simulated.timing.messages[i];
    add(can_id_text(one.message.can_id, one.message.extended), one.name, simulated.result.messages[i], bound_of(one));
  }
  for (const OtherFrames& one : simulated.result.others) {
    add(can_id_text(one.can_id, one.extended), sender_of(simulated, one) + ", other frames", one.seen, std::nullopt);
  }
  for (std::string& line : table.lines()) lines.push_back(std::move(line));
}

Json seen_json(const SeenFrames& seen) {
  Json json{{"count", seen.count}, {"worst_us", nullptr}, {"at_us", nullptr}};
  if (seen.count != 0) {
    json["worst_us"] = seen.worst_us;
    json["at_us"] = seen.at_us;
  }
  return json;
}

Json message_json(const SimulatedNetwork& simulated, std::size_t place) {
  const TimedMessage& one = simulated.timing.messages[place];
  Json json{{"can_id", one.message.can_id},
            {"extended", one.message.extended},
            {"remote", one.message.remote},
            {"name", one.name}};
  json.update(seen_json(simulated.result.messages[place]));
  const auto bound = bound_of(one);
  json["bound_us"] = nullptr;
  if (bound) json["bound_us"] = *bound;
  json["lost_values"] = lost_values(simulated.result, place);
  return json;
}

Json other_json(const SimulatedNetwork& simulated, const OtherFrames& one) {
  Json json{{"can_id", one.can_id}, {"extended", one.extended}, {"remote", one.remote}};
  json["node"] = nullptr;
  if (one.node) json["node"] = node_of(simulated, *one.node).name;
  json.update(seen_json(one.seen));
  return json;
}

Json event_json(const SimulatedNetwork& simulated, const SimulationEvent& event) {
  constexpr std::string_view kinds[] = {"emergency", "heartbeat_lost", "heartbeat_back", "state"};
  Json json{{"kind", kinds[static_cast<std::size_t>(event.kind)]},
            {"time_us", event.time_us},
            {"node", node_of(simulated, event.node).name}};
  if (event.kind == Kind::emergency) {
    json["code"] = event.code;
    json["error_register"] = event.error_register;
  } else if (event.kind == Kind::state) {
    json["state"] = nmt_state_text(event.state);
  } else {
    json["other"] = node_with_id(simulated, event.other);
  }
  return json;
}

}  // namespace

std::vector<std::string> simulation_problems(const SimulatedNetwork& simulated) {
  const SimulationResult& result = simulated.result;
  std::vector<std::string> problems;
  for (const RefusedEntry& one : result.refused) {
    problems.push_back(fmt::format(
        "{}: {} is rejected with abort code {:08X}h", node_of(simulated, one.node).name,
        entry_label(static_cast<std::uint16_t>(one.index), static_cast<std::uint8_t>(one.sub_index)), one.abort_code));
  }
  const bool bounds_hold = !has_node_fault(simulated.faults);
  for (std::size_t i = 0; bounds_hold && i < result.messages.size(); ++i) {
    const TimedMessage& one = simulated.timing.messages[i];
    const auto bound = bound_of(one);
    if (bound && result.messages[i].worst_us > *bound) {
      problems.push_back(fmt::format("{}: response time of {} ms exceeds the bound of {} ms", one.name,
                                     milliseconds_of(result.messages[i].worst_us), milliseconds_of(*bound)));
    }
    if (const std::uint64_t lost = lost_values(result, i); lost != 0) {
      problems.push_back(fmt::format("{}: {} not sent", one.name, counted(lost, "new value")));
    }
  }
  for (std::size_t i = 0; i < result.nodes.size(); ++i) {
    const SimulatedNodeEnd& end = result.nodes[i];
    const bool is_operational = end.condition == Condition::running && end.state == canopen::NmtState::operational;
    if (is_operational || is_faulty(simulated.faults, i)) continue;
    problems.push_back(fmt::format("{} is {} at the end, not {}", node_of(simulated, i).name, condition_text(end),
                                   nmt_state_text(canopen::NmtState::operational)));
  }
  add_problems_of_losses(simulated, problems);
  return problems;
}

std::vector<std::string> simulation_lines(const SimulatedNetwork& simulated) {
  const SimulationResult& result = simulated.result;
  const BusLoad& load = simulated.timing.load;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{} for {} at {} kbit/s: {}", counted(result.nodes.size(), "node"),
                              seconds_of(static_cast<std::int64_t>(result.measured_us)),
                              simulated.network.description.bit_rate->value, counted(result.frames, "frame")));
  lines.push_back(fmt::format("load {:.1f} %, {:.1f} % in the busiest second; computed {:.1f} to {:.1f} %",
                              load_of(result.busy_us, result.measured_us), busiest_load(result), load.min * 100,
                              load.max * 100));
  if (result.errors != 0) lines.push_back(fmt::format("{} destroyed by errors", counted(result.errors, "frame")));
  lines.emplace_back();
  add_frames(simulated, lines);
  lines.emplace_back();
  for (const SimulationFault& fault : simulated.faults) lines.push_back(fmt::format("fault {}", fault.text));
  for (const SimulationEvent& event : result.events) {
    if (is_shown(event))
      lines.push_back(fmt::format("{}: {}", seconds_of(event.time_us), event_text(simulated, event)));
  }
  for (std::size_t i = 0; i < result.nodes.size(); ++i) {
    const SimulatedNodeEnd& end = result.nodes[i];
    if (end.condition == Condition::running && end.state == canopen::NmtState::operational) continue;
    lines.push_back(fmt::format("{} is {} at the end", node_of(simulated, i).name, condition_text(end)));
  }
  const auto operational = std::ranges::count_if(result.nodes, [](const SimulatedNodeEnd& end) {
    return end.condition == Condition::running && end.state == canopen::NmtState::operational;
  });
  lines.push_back(fmt::format("{} of {} Operational at the end", operational, counted(result.nodes.size(), "node")));
  return lines;
}

Json simulation_json(const SimulatedNetwork& simulated) {
  const SimulationResult& result = simulated.result;
  Json json{{"schema", 2}, {"problems", simulation_problems(simulated)}, {"measured_us", result.measured_us}};
  json["load"] = {{"seen", load_of(result.busy_us, result.measured_us)},
                  {"busiest_second", busiest_load(result)},
                  {"computed_min", simulated.timing.load.min * 100},
                  {"computed_max", simulated.timing.load.max * 100}};
  json["frames"] = result.frames;
  json["errors"] = result.errors;
  json["faults"] = Json::array();
  for (const SimulationFault& fault : simulated.faults) json["faults"].push_back(fault.text);
  json["messages"] = Json::array();
  for (std::size_t i = 0; i < result.messages.size(); ++i) json["messages"].push_back(message_json(simulated, i));
  json["other_frames"] = Json::array();
  for (const OtherFrames& one : result.others) json["other_frames"].push_back(other_json(simulated, one));
  json["events"] = Json::array();
  for (const SimulationEvent& event : result.events) json["events"].push_back(event_json(simulated, event));
  json["nodes"] = Json::array();
  for (std::size_t i = 0; i < result.nodes.size(); ++i) {
    json["nodes"].push_back({{"name", node_of(simulated, i).name},
                             {"node_id", node_of(simulated, i).node_id},
                             {"state", condition_text(result.nodes[i])}});
  }
  return json;
}

}  // namespace edsc
