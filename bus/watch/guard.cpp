#include "watch/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/can/frame_length.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <utility>

#include "network/communication_objects.hpp"
#include "text/counted.hpp"
#include "values/little_endian.hpp"
#include "values/nmt_text.hpp"

namespace edsc::watch {
namespace {

using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::int64_t second_us = 1'000'000;
constexpr std::int64_t boot_time_us = 30 * second_us;   ///< from a boot-up message to the first heartbeat
constexpr std::int64_t reset_time_us = 10 * second_us;  ///< from a reset command to the boot-up message
constexpr std::int64_t reaction_us = 200'000;           ///< frames that a node had queued before a command
constexpr std::int64_t other_frames_us = 50'000;        ///< delay of a cyclic frame by others
constexpr std::int64_t gap_of_bus_us = 100'000;         ///< no frame of any node

std::string milliseconds(std::int64_t us) { return fmt::format("{}.{} ms", us / 1000, us % 1000 / 100); }

std::string can_id(const Frame& frame) { return can_id_text(frame.id, frame.extended); }

std::string hex(std::span<const std::uint8_t> bytes) {
  const bool is_number = bytes.size() == 1 || bytes.size() == 2 || bytes.size() == 4;
  if (is_number) return fmt::format("{:0{}X}h", number_of(bytes), bytes.size() * 2);
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

std::string hex(const std::string& bytes) {
  return hex(std::span{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// An expedited transfer may not state its length: the value then has four bytes, the last of them 0.
bool same(const std::string& expected, std::span<const std::uint8_t> value) {
  const auto byte = [](char c) { return static_cast<std::uint8_t>(c); };
  if (value.size() < expected.size()) return false;
  const auto rest = value.subspan(expected.size());
  const bool is_unstated = value.size() == 4 && std::ranges::all_of(rest, [](std::uint8_t one) { return one == 0; });
  return (rest.empty() || is_unstated) && std::ranges::equal(expected, value.first(expected.size()), {}, byte);
}

/// The node-ID in a CAN-ID of EMCY, SDO or error control by the pre-defined connection set; 0: none.
std::uint8_t predefined_node(const Frame& frame) {
  namespace code = canopen::function_code;
  if (frame.extended) return 0;
  const std::uint32_t function = frame.id & 0x780;
  const bool is_of_node = function == code::emcy || function == code::sdo_request || function == code::sdo_response ||
                          function == code::error_control;
  return is_of_node ? static_cast<std::uint8_t>(frame.id & 0x7F) : std::uint8_t{0};
}

/// Whether a value is one that a master writes on its way to the configured one.
bool is_intermediate(std::uint16_t index, std::uint8_t sub_index, const std::string& expected,
                     std::span<const std::uint8_t> value) {
  constexpr std::uint32_t invalid = canopen::CobId::invalid_bit;
  const bool is_communication = (index >= 0x1400 && index <= 0x15FF) || (index >= 0x1800 && index <= 0x19FF);
  if (is_communication && sub_index == 1 && value.size() == 4) return (number_of(value) & invalid) != 0;
  const bool is_mapping = (index >= 0x1600 && index <= 0x17FF) || (index >= 0x1A00 && index <= 0x1BFF);
  if (is_mapping && sub_index == 0) return number_of(value) == 0;
  const bool is_cob_id = index == communication::cob_id_sync || (index >= 0x1200 && index <= 0x12FF);
  return is_cob_id && expected.size() == 4 && value.size() == 4 && (number_of(value) & invalid) != 0;
}

}  // namespace

Guard::Guard(const Network& network, GuardSettings settings, Sink sink)
    : allowed_{network},
      settings_{std::move(settings)},
      sink_{std::move(sink)},
      nodes_(network.nodes.size()),
      frames_(allowed_.frames().size()) {
  constexpr std::uint64_t default_load = 80;
  places_of_nodes_.fill(-1);
  for (std::size_t at = 0; at < nodes_.size(); ++at) {
    NodeState& state = nodes_[at];
    state.node = &network.nodes[at];
    state.times = allowed_.times_of(*state.node);
    const auto start_up = value_of(state.node->device(), 0x1F80);
    state.starts_itself = start_up && (*start_up & canopen::nmt_start_up::no_self_start) == 0;
    places_of_nodes_[state.node->node_id] = static_cast<std::int16_t>(at);
    if (state.node == network.master()) master_ = &state;
  }
  const NetworkDescription& file = network.description;
  if (file.bit_rate) {
    max_bits_ = std::uint64_t{file.bit_rate->value} * 10 * (file.max_load ? file.max_load->value : default_load);
  }
}

Guard::NodeState* Guard::state_of(std::uint8_t node_id) {
  const std::int16_t place = places_of_nodes_[node_id & 0x7F];
  return place < 0 ? nullptr : &nodes_[static_cast<std::size_t>(place)];
}

void Guard::raise(AlarmId id, const NodeState* node, std::string text, const Frame* frame, std::uint32_t detail) {
  Alarm alarm{.id = id, .us = now_us_, .text = std::move(text), .detail = detail};
  if (node != nullptr) {
    alarm.node_id = node->node->node_id;
    alarm.node = node->node->name;
  }
  if (frame != nullptr) {
    alarm.has_can_id = true;
    alarm.cob_id = canopen::cob_id_of(*frame);
  }
  sink_(std::move(alarm));
}

// Time

void Guard::pass(std::int64_t us) {
  if (!has_begun_) {
    has_begun_ = true;
    now_us_ = last_frame_us_ = us;
    second_ = us / second_us;
    for (NodeState& node : nodes_) {
      node.heard_us = us;
      if (node.times.timeout_us != 0) node.due_us = us + std::max(boot_time_us, node.times.timeout_us);
    }
    find_next_due();
    return;
  }
  check_due(us);
  now_us_ = std::max(now_us_, us);
}

void Guard::find_next_due() {
  next_due_us_ = never;
  for (const NodeState& node : nodes_) next_due_us_ = std::min(next_due_us_, node.due_us);
  for (const FrameState& frame : frames_) next_due_us_ = std::min(next_due_us_, frame.due_us);
}

void Guard::check_due(std::int64_t us) {
  while (us >= next_due_us_) {
    find_next_due();
    if (us < next_due_us_) return;
    now_us_ = next_due_us_;
    for (NodeState& node : nodes_) {
      if (node.due_us <= now_us_) miss_node(node);
    }
    for (std::size_t at = 0; at < frames_.size(); ++at) {
      if (frames_[at].due_us <= now_us_) pass_due_frame(at);
    }
    find_next_due();
  }
}

/// A node that may be missing gets its heartbeat's time: its frames are missing if it is not.
void Guard::pass_due_frame(std::size_t at) {
  FrameState& state = frames_[at];
  state.due_us = never;
  NodeState& node = *state_of(allowed_.frames()[at].node->node_id);
  if (node.is_missing) return;
  state.is_late = true;
  if (node.times.timeout_us == 0) report_late(node);
}

/// Reports the frames of the node that are missing.
void Guard::report_late(const NodeState& node) {
  for (std::size_t at = 0; at < frames_.size(); ++at) {
    if (allowed_.frames()[at].node == node.node && std::exchange(frames_[at].is_late, false))
      report_late_frame(node, at);
  }
}

void Guard::report_late_frame(const NodeState& node, std::size_t at) {
  const AllowedFrame& allowed = allowed_.frames()[at];
  const auto detail = static_cast<std::uint32_t>(at);
  if (allowed.sync_cycles != 0) {
    const std::string cycles = counted(2 * std::size_t{allowed.sync_cycles}, "SYNC cycle");
    return raise("pdo-missing", &node, fmt::format("no {} in {}", allowed.name, cycles), nullptr, detail);
  }
  const bool is_sync = allowed.service == FrameService::sync;
  const std::int64_t period = is_sync ? allowed.period_us : allowed.longest_us;
  raise(is_sync ? AlarmId{"sync-missing"} : AlarmId{"pdo-missing"}, &node,
        fmt::format("no {} for {}; expected every {}", allowed.name, milliseconds(2 * period + other_frames_us),
                    milliseconds(period)),
        nullptr, detail);
}

void Guard::miss_node(NodeState& node) {
  node.due_us = never;
  for (std::size_t at = 0; at < frames_.size(); ++at) {
    if (allowed_.frames()[at].node == node.node) frames_[at] = {};
  }
  if (std::exchange(node.is_missing, true)) return;
  const char* const what = node.times.heartbeat_us != 0 ? "heartbeat" : "response to guarding";
  std::string text = node.is_seen ? fmt::format("no {} for {}", what, milliseconds(now_us_ - node.heard_us))
                                  : fmt::format("no {} since the start", what);
  Alarm alarm{.id = AlarmId{"node-missing"},
              .us = now_us_,
              .node_id = node.node->node_id,
              .node = node.node->name,
              .text = std::move(text)};
  miss({std::move(alarm), node.node->node_id});
}

/// While no frame is received, what is missing waits: if it concerns two nodes, the bus is silent.
void Guard::miss(Missing missing) {
  if (is_silent_) return;
  missing_.push_back(std::move(missing));
  const auto is_other = [&](const Missing& one) { return one.node_id != missing_.front().node_id; };
  if (std::ranges::any_of(missing_, is_other)) flush_missing(now_us_);
}

void Guard::flush_missing(std::int64_t us) {
  if (missing_.empty()) return;
  std::vector<Missing> missing = std::exchange(missing_, {});
  const auto is_other = [&](const Missing& one) { return one.node_id != missing.front().node_id; };
  if (std::ranges::none_of(missing, is_other)) {
    for (Missing& one : missing) sink_(std::move(one.alarm));
    return;
  }
  is_silent_ = true;
  now_us_ = us;
  raise("bus-silent", nullptr, fmt::format("no frame for {}", milliseconds(us - last_frame_us_)));
}

/// All nodes have their time again after the first frame.
void Guard::end_silence() {
  is_silent_ = false;
  for (NodeState& node : nodes_) {
    node.is_missing = false;
    node.heard_us = now_us_;
    if (node.times.timeout_us != 0) node.due_us = now_us_ + std::max(boot_time_us, node.times.timeout_us);
    node.is_operational.reset();
  }
  for (FrameState& frame : frames_) frame = {};
  find_next_due();
}

void Guard::count_load(const Frame& frame) {
  if (max_bits_ == 0) return;
  const std::int64_t second = now_us_ / second_us;
  if (second != second_) {
    if (bits_ > max_bits_) {
      const unsigned bit_rate = allowed_.network().description.bit_rate->value;
      raise("bus-load", nullptr,
            fmt::format("{} % in a second; the limit is {} %", bits_ / (bit_rate * 10U), max_bits_ / (bit_rate * 10U)));
    }
    bits_ = 0;
    second_ = second;
  }
  bits_ += canopen::stuffed_bits_on_wire(frame);
}

// Frames

void Guard::see(const Frame& frame, std::int64_t us) {
  pass(us);
  flush_missing(us);
  now_us_ = std::max(now_us_, us);
  if (is_silent_) end_silence();
  if (now_us_ - last_frame_us_ >= gap_of_bus_us) gap_us_ = now_us_;
  last_frame_us_ = now_us_;
  count_load(frame);
  if (!frame.extended && frame.id == canopen::function_code::nmt) return see_nmt(frame);
  const auto place = allowed_.find(frame);
  if (!place) return see_unknown(frame);
  const AllowedFrame& allowed = allowed_.frames()[*place];
  NodeState& node = *state_of(allowed.node->node_id);
  if (frame.remote) {
    const bool is_guarding = allowed.service == FrameService::error_control && node.times.heartbeat_us == 0;
    if (!is_guarding && !allowed.is_requested) {
      raise("remote-frame", &node, fmt::format("remote frame for {}", allowed.name), &frame);
    }
    return;
  }
  if (frame.size < allowed.min_bytes || frame.size > allowed.max_bytes) {
    const bool is_pdo = allowed.service == FrameService::pdo;
    raise(is_pdo ? AlarmId{"pdo-length"} : AlarmId{"frame-length"}, &node,
          fmt::format("{} with {}; expected {}", allowed.name, counted(unsigned{frame.size}, "byte"),
                      unsigned{allowed.max_bytes}),
          &frame);
    return;
  }
  switch (allowed.service) {
    case FrameService::error_control: return see_error_control(frame, node);
    case FrameService::sync: return see_sync(frame, allowed, frames_[*place]);
    case FrameService::pdo: return see_pdo(frame, allowed, frames_[*place]);
    case FrameService::sdo: return see_sdo(frame, allowed);
    case FrameService::nmt:
    case FrameService::time:
    case FrameService::emcy: return;
  }
}

void Guard::see_unknown(const Frame& frame) {
  if (!frame.extended && (frame.id == canopen::lss::request_id || frame.id == canopen::lss::response_id)) {
    const bool is_request = frame.id == canopen::lss::request_id;
    raise("lss-command", nullptr,
          fmt::format("LSS {} {:02X}h", is_request ? "command" : "response", frame.size > 0 ? frame.data[0] : 0),
          &frame);
    return;
  }
  const std::uint8_t node_id = predefined_node(frame);
  if (node_id != 0 && state_of(node_id) == nullptr) {
    raise("node-unknown", nullptr, fmt::format("CAN-ID {} of node-ID {}", can_id(frame), node_id), &frame);
    return;
  }
  const std::string receiver = allowed_.receiver_of(frame);
  std::string text = fmt::format("CAN-ID {}", can_id(frame));
  if (!receiver.empty()) text += fmt::format(", which no node sends; {} receives it", receiver);
  raise("can-id-unknown", node_id != 0 ? state_of(node_id) : nullptr, std::move(text), &frame);
}

// SYNC and PDOs

void Guard::see_sync(const Frame& frame, const AllowedFrame& allowed, FrameState& state) {
  NodeState& producer = *state_of(allowed.node->node_id);
  const std::int64_t distance = state.last_us == -never ? never : now_us_ - state.last_us;
  if (allowed.period_us != 0 && distance < allowed.period_us / 2) {
    raise("sync-rate", &producer,
          fmt::format("SYNC after {}; expected every {}", milliseconds(distance), milliseconds(allowed.period_us)),
          &frame);
    return;  // the earlier frame began the cycle
  }
  state.last_us = now_us_;
  if (std::exchange(state.is_late, false))
    report_late_frame(producer, static_cast<std::size_t>(&state - frames_.data()));
  if (allowed.period_us != 0) {
    state.due_us = now_us_ + 2 * allowed.period_us + other_frames_us;
    next_due_us_ = std::min(next_due_us_, state.due_us);
  }
  for (std::size_t at = 0; at < frames_.size(); ++at) {
    const AllowedFrame& pdo = allowed_.frames()[at];
    if (pdo.sync_cycles == 0) continue;
    FrameState& one = frames_[at];
    const NodeState& sender = *state_of(pdo.node->node_id);
    if (sender.is_operational != true || sender.is_missing || now_us_ - sender.state_us < reaction_us) {
      one.credit.reset();
      one.silent_syncs = 0;
      continue;
    }
    const auto cycles = static_cast<int>(pdo.sync_cycles);
    one.credit = std::min(one.credit.value_or(cycles - 1) + 1, 2 * cycles);
    if (++one.silent_syncs == 2 * pdo.sync_cycles + 1) pass_due_frame(at);
  }
}

void Guard::see_pdo(const Frame& frame, const AllowedFrame& allowed, FrameState& state) {
  NodeState& node = *state_of(allowed.node->node_id);
  if (node.is_operational == false) {
    if (node.node->is_master || node.starts_itself) {
      set_operational(node, true);
    } else if (now_us_ - node.state_us > reaction_us) {
      raise("pdo-state", &node, fmt::format("{} of a node that is not Operational", allowed.name), &frame);
    }
  }
  // If the whole bus was silent, or was not recorded, the PDO alone was not missing.
  if (std::exchange(state.is_late, false) && gap_us_ < state.last_us) {
    report_late_frame(node, static_cast<std::size_t>(&state - frames_.data()));
  }
  const std::int64_t distance = state.last_us == -never ? never : now_us_ - state.last_us;
  state.last_us = now_us_;
  state.silent_syncs = 0;
  if (allowed.longest_us != 0 && node.is_operational != false) {
    state.due_us = now_us_ + 2 * allowed.longest_us + other_frames_us;
    next_due_us_ = std::min(next_due_us_, state.due_us);
  }
  if (allowed.sync_cycles != 0) {
    if (!state.credit) return;
    *state.credit -= static_cast<int>(allowed.sync_cycles);
    if (*state.credit >= 0) return;
    state.credit = 0;
    raise("pdo-rate", &node, fmt::format("{} twice after a SYNC", allowed.name), &frame);
    return;
  }
  if (allowed.inhibit_us != 0 && distance < allowed.inhibit_us / 2) {
    raise("pdo-rate", &node,
          fmt::format("{} after {}; its inhibit time is {}", allowed.name, milliseconds(distance),
                      milliseconds(allowed.inhibit_us)),
          &frame);
  } else if (allowed.period_us != 0 && state.rate.exceeds(now_us_, allowed.period_us)) {
    raise("pdo-rate", &node, fmt::format("{} more often than every {}", allowed.name, milliseconds(allowed.period_us)),
          &frame);
  }
}

// NMT and error control

void Guard::set_operational(NodeState& node, std::optional<bool> is_operational) {
  if (node.is_operational == is_operational) return;
  node.is_operational = is_operational;
  node.state_us = now_us_;
  for (std::size_t at = 0; at < frames_.size(); ++at) {
    const AllowedFrame& allowed = allowed_.frames()[at];
    if (allowed.node != node.node || allowed.service != FrameService::pdo) continue;
    FrameState& state = frames_[at];
    state.due_us = never;
    state.is_late = false;
    state.credit.reset();
    state.silent_syncs = 0;
    state.rate.restart();
    if (is_operational != true || allowed.longest_us == 0) continue;
    state.due_us = now_us_ + 2 * allowed.longest_us + other_frames_us + reaction_us;
    next_due_us_ = std::min(next_due_us_, state.due_us);
  }
  node.heartbeats.restart();
}

bool Guard::may_reset(NodeState& node) {
  if (node.is_missing || !node.is_seen || node.is_operational != true) return true;
  if (now_us_ - node.restarted_us < reset_time_us && node.restarted_us != -never) return true;
  // The master may find the node missing slightly earlier than the guard.
  const bool is_late = node.times.timeout_us != 0 && now_us_ - node.heard_us >= node.times.timeout_us * 9 / 10;
  if (is_late) miss_node(node);
  return is_late;
}

bool Guard::is_of_master(NmtCommand command, std::uint8_t node_id) {
  if (master_ == nullptr) return false;
  const auto is_up = [&](const NodeState& node) {
    return node.node != master_->node && node.is_operational == true && !node.is_missing;
  };
  const auto is_missing = [](const NodeState& node) { return node.is_missing; };
  if (node_id == 0) {
    constexpr std::int64_t start_us = 5 * second_us;
    const bool starts = master_->booted_us != -never && now_us_ - master_->booted_us < start_us;
    switch (command) {
      case NmtCommand::start:
        return std::ranges::any_of(nodes_,
                                   [&](const NodeState& node) { return node.node != master_->node && !is_up(node); });
      case NmtCommand::stop: return std::ranges::any_of(nodes_, is_missing);
      case NmtCommand::enter_pre_operational: return starts || std::ranges::none_of(nodes_, is_up);
      case NmtCommand::reset_node:
      case NmtCommand::reset_communication:
        return starts || std::ranges::none_of(nodes_, is_up) || std::ranges::any_of(nodes_, is_missing);
    }
    return false;
  }
  NodeState* const node = state_of(node_id);
  if (node == nullptr || node == master_) return false;
  switch (command) {
    case NmtCommand::start:
    case NmtCommand::enter_pre_operational: return !is_up(*node);
    case NmtCommand::stop: return node->is_missing;
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication: return may_reset(*node);
  }
  return false;
}

void Guard::see_nmt(const Frame& frame) {
  const auto* const row =
      frame.remote || frame.size != 2 ? nullptr : find_nmt_command(&NmtCommandText::command, NmtCommand{frame.data[0]});
  if (row == nullptr || frame.data[1] > 127) {
    raise("nmt-command", nullptr, "an unknown NMT command", &frame);
    return;
  }
  const std::uint8_t node_id = frame.data[1];
  const bool is_foreign = !is_of_master(row->command, node_id);
  if (is_foreign) {
    const NodeState* const node = node_id != 0 ? state_of(node_id) : nullptr;
    const std::string whom = node_id == 0      ? "all nodes"
                             : node != nullptr ? node->node->name
                                               : fmt::format("node-ID {}", node_id);
    raise("nmt-command", node, fmt::format("{}: {}", row->text, whom), &frame,
          std::uint32_t{frame.data[0]} << 8 | node_id);
  }
  for (NodeState& node : nodes_) {
    if ((node_id == 0 || node.node->node_id == node_id) && !node.node->is_master) apply(row->command, node, is_foreign);
  }
}

/// After a foreign command, the state is known with the next heartbeat.
void Guard::apply(NmtCommand command, NodeState& node, bool is_foreign) {
  const bool is_reset = command == NmtCommand::reset_node || command == NmtCommand::reset_communication;
  if (is_reset) node.reset_us = now_us_;
  if (is_foreign) return set_operational(node, std::nullopt);
  if (is_reset) {
    set_operational(node, false);
    if (!node.is_missing && node.times.timeout_us != 0) {
      node.due_us = now_us_ + std::max(boot_time_us, node.times.timeout_us);
    }
    return;
  }
  set_operational(node, command == NmtCommand::start);
}

void Guard::see_boot_up(const Frame& frame, NodeState& node) {
  const bool is_commanded = node.reset_us != -never && now_us_ - node.reset_us < reset_time_us;
  if (node.is_seen && !node.is_missing && !is_commanded) {
    const bool was_up = node.is_operational == true;
    raise("node-restarted", &node,
          was_up ? "boot-up message while it was Operational" : "boot-up message without a reset", &frame);
    node.restarted_us = now_us_;
  }
  node.reset_us = -never;
  node.is_seen = true;
  node.is_missing = false;
  node.is_current = false;
  node.heard_us = node.booted_us = now_us_;
  set_operational(node, false);
  node.state_us = now_us_;
  if (node.times.timeout_us == 0) return;
  node.due_us = now_us_ + std::max(boot_time_us, node.times.timeout_us);
  next_due_us_ = std::min(next_due_us_, node.due_us);
}

void Guard::see_error_control(const Frame& frame, NodeState& node) {
  const auto message = canopen::error_control_message(frame);
  if (!message) {
    raise("node-state", &node, fmt::format("unknown NMT state {:02X}h", frame.data[0] & 0x7F), &frame);
    return;
  }
  if (message->state == NmtState::initialisation && !message->toggle) return see_boot_up(frame, node);
  const bool is_up = message->state == NmtState::operational;
  const bool has_changed = node.is_operational && *node.is_operational != is_up;
  const bool is_late = has_changed && now_us_ - node.state_us < std::max(reaction_us, node.times.heartbeat_us / 4);
  const bool may_change = node.node->is_master || node.starts_itself || node.is_missing;
  if (has_changed && !is_late && !may_change) {
    raise("node-state", &node,
          fmt::format("{} without a command; it was {}", canopen::to_text(message->state),
                      is_up ? "not Operational" : "Operational"),
          &frame);
  }
  node.is_seen = true;
  node.is_missing = false;
  node.heard_us = now_us_;
  if (!is_late) set_operational(node, is_up);
  if (node.times.timeout_us != 0) {
    node.due_us = now_us_ + node.times.timeout_us + std::max(node.times.timeout_us / 10, other_frames_us);
    next_due_us_ = std::min(next_due_us_, node.due_us);
  }
  if (is_up) report_late(node);
  if (!is_up || node.times.heartbeat_us == 0) return;
  if (!node.heartbeats.exceeds(now_us_, node.times.heartbeat_us)) return;
  raise("node-duplicate", &node,
        fmt::format("heartbeats more often than every {}", milliseconds(node.times.heartbeat_us)), &frame);
}

// SDO

void Guard::see_sdo(const Frame& frame, const AllowedFrame& allowed) {
  NodeState& node = *state_of(allowed.node->node_id);
  const bool is_request = allowed.sdo == SdoFrames::requests;
  message_.clear();
  node.sdo.follow({frame, true, now_us_}, is_request, nullptr, message_);
  if (is_request) {
    // A frame of a block download may look like the first one of a transfer, but for its object.
    const canopen::sdo::ClientCommand command = canopen::sdo::client_command(frame.data[0]);
    const bool is_first = command == canopen::sdo::ClientCommand::initiate_download ||
                          (command == canopen::sdo::ClientCommand::block_download && (frame.data[0] & 1) == 0);
    const bool begins = is_first && message_.step == TransferStep::part && message_.download &&
                        message_.index == canopen::sdo::index_of(frame.data) && message_.sub_index == frame.data[3];
    if (!begins) return;
    const bool is_expedited = command == canopen::sdo::ClientCommand::initiate_download &&
                              (frame.data[0] & canopen::sdo::expedited) != 0 &&
                              (frame.data[0] & canopen::sdo::size_indicated) != 0;
    const std::size_t size = is_expedited ? 4U - (frame.data[0] >> 2U & 3U) : 0U;
    return see_write(frame, node, message_, std::span{frame.data}.subspan(4, size));
  }
  if (message_.step != TransferStep::finished) return;
  const std::span<const std::uint8_t> value = node.sdo.whole_value();
  if (value.empty()) return;
  if (message_.download) return check_written(frame, node, message_, value);
  check_read(frame, node, message_, value);
}

/// `value` is empty unless the frame has it.
void Guard::see_write(const Frame& frame, NodeState& node, const Message& message,
                      std::span<const std::uint8_t> value) {
  const std::uint16_t index = message.index;
  const std::uint8_t sub_index = message.sub_index;
  if (settings_.allowed_writes.contains({node.node->node_id, index, sub_index})) return;
  const std::uint32_t detail = std::uint32_t{index} << 8 | sub_index;
  const std::string written = value.empty() ? std::string{} : " = " + hex(value);
  const std::string what = fmt::format("write of {}{}", entry_name(*node.node, index, sub_index), written);
  if (!AllowedTraffic::is_configured(*node.node, index, sub_index)) {
    raise("sdo-write", &node, what + "; it is not in the configuration", &frame, detail);
  } else if (node.is_operational == true && !node.is_missing) {
    raise("sdo-write", &node, what + " while the node is Operational", &frame, detail);
  }
}

void Guard::check_written(const Frame& frame, NodeState& node, const Message& message,
                          std::span<const std::uint8_t> value) {
  const std::uint16_t index = message.index;
  const std::uint8_t sub_index = message.sub_index;
  if (settings_.allowed_writes.contains({node.node->node_id, index, sub_index})) return;
  if (!AllowedTraffic::is_configured(*node.node, index, sub_index)) return;
  const std::string expected = AllowedTraffic::configured_value(*node.node, index, sub_index);
  if (expected.empty() || same(expected, value) || is_intermediate(index, sub_index, expected, value)) return;
  raise("sdo-value", &node,
        fmt::format("{} = {}; the network file states {}", entry_name(*node.node, index, sub_index), hex(value),
                    hex(expected)),
        &frame, std::uint32_t{index} << 8 | sub_index);
}

void Guard::check_read(const Frame& frame, NodeState& node, const Message& message,
                       std::span<const std::uint8_t> value) {
  const std::uint16_t index = message.index;
  const std::uint8_t sub_index = message.sub_index;
  const std::string expected = AllowedTraffic::configured_value(*node.node, index, sub_index);
  const std::uint32_t detail = std::uint32_t{index} << 8 | sub_index;
  const auto text = [&](const std::string& right) {
    return fmt::format("{} is {}; the network file states {}", entry_name(*node.node, index, sub_index), hex(value),
                       right);
  };
  const bool is_identity = index == 0x1000 || (index == communication::identity && sub_index >= 1 && sub_index <= 4);
  if (is_identity) {
    if (index == communication::identity && sub_index == 4) {
      const WrittenNumber& serial = node.node->description->serial_number;
      if (!serial || number_of(value) == serial->value) return;
      raise("node-replaced", &node, text(fmt::format("{:08X}h", serial->value)), &frame, detail);
      return;
    }
    const bool is_stated = std::ranges::any_of(expected, [](char byte) { return byte != 0; });
    if (is_stated && !same(expected, value)) raise("node-replaced", &node, text(hex(expected)), &frame, detail);
    return;
  }
  if (index == communication::verify_configuration) {
    const auto stated = value_of(node.node->device(), index, sub_index);
    const bool is_stated = node.node->settings.find(index, sub_index) != nullptr || node.node->description->dcf;
    const std::uint64_t number = number_of(value);
    node.is_current = is_stated && stated.value_or(0) != 0 && number == *stated;
    if (sub_index == 0 || number == 0 || !is_stated || stated.value_or(0) == 0 || number == *stated) return;
    raise("node-configuration", &node, text(fmt::format("{}", *stated)), &frame, detail);
    return;
  }
  const bool is_set = node.node->settings.find(index, sub_index) != nullptr;
  const bool is_in_force = node.is_current || (node.is_operational == true && !node.is_missing);
  if (!is_set || !is_in_force || expected.empty() || same(expected, value)) return;
  raise("node-configuration", &node, text(hex(expected)), &frame, detail);
}

}  // namespace edsc::watch
