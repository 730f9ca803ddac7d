#include "monitor/monitor_state.hpp"

#include <algorithm>
#include <canopen/can/frame_length.hpp>

#include "decode/log/value_number.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

constexpr std::int64_t second_us = 1'000'000;
constexpr std::size_t max_others = 4096;

/// Whether the mapping of a PDO is that of its last frame.
bool has_same_objects(const MonitoredPdo& pdo, const Message& message) {
  return std::ranges::equal(pdo.values, message.values, [](const MonitoredValue& one, const MessageValue& other) {
    return one.index == other.index && one.sub_index == other.sub_index;
  });
}

}  // namespace

bool MonitorState::add(const canopen::Frame& frame, const Message& message, std::int64_t now_us) {
  frames_.count();
  bits_.count(canopen::bits_on_wire(frame));
  switch (message.service) {
    case Service::boot_up:
    case Service::heartbeat:
    case Service::guarding: return add_state(message, now_us);
    case Service::tpdo:
    case Service::rpdo: return add_pdo(frame, message, now_us);
    case Service::emcy: {
      MonitoredNode& node = node_of(message.node_id);
      ++node.emergencies;
      node.emergency = message.text;
      node.error_code = message.error_code;
      node.emergency_us = now_us;
      return true;
    }
    case Service::sdo: return message.step == TransferStep::finished || message.step == TransferStep::aborted;
    case Service::nmt: add_command(frame); return true;
    case Service::lss:
    case Service::error_frame: return true;
    case Service::sync:
    case Service::time:
    case Service::unknown: {
      const std::uint32_t cob_id = canopen::cob_id_of(frame);
      if (others_.size() >= max_others && !others_.contains(cob_id)) return false;
      const auto [row, first] = others_.try_emplace(cob_id);
      row->second.count();
      return first;
    }
  }
  return false;
}

MonitoredNode& MonitorState::node_of(std::uint8_t node_id) {
  const auto [node, is_new] = nodes_.try_emplace(node_id);
  if (is_new) node->second.assumed = commanded_[node_id & 0x7F];
  return node->second;
}

/// Nodes do not confirm NMT commands: the new state is assumed until error control reports it.
void MonitorState::add_command(const canopen::Frame& frame) {
  if (frame.remote || frame.size < 2 || frame.data[1] >= commanded_.size()) return;
  const auto command = static_cast<canopen::NmtCommand>(frame.data[0]);
  const NmtCommandText* const row = find_nmt_command(&NmtCommandText::command, command);
  if (row == nullptr) return;
  std::optional<canopen::NmtState> state = row->leads_to;
  if (state == canopen::NmtState::initialisation) state.reset();  // a boot-up message reports the end of a reset
  const std::uint8_t node_id = frame.data[1];
  for (std::size_t i = 1; i < commanded_.size(); ++i) {
    const auto id = static_cast<std::uint8_t>(i);
    if (node_id != 0 && id != node_id) continue;
    commanded_[id] = state;
    if (nodes_.contains(id)) assume(id, state);
  }
}

void MonitorState::assume(std::uint8_t node_id, std::optional<canopen::NmtState> state) {
  MonitoredNode& node = node_of(node_id);
  node.assumed = node.state == state ? std::nullopt : state;
}

bool MonitorState::add_state(const Message& message, std::int64_t now_us) {
  if (!message.state || message.node_id == 0) return false;
  commanded_[message.node_id & 0x7F].reset();
  MonitoredNode& node = node_of(message.node_id);
  const bool booted = message.service == Service::boot_up;
  const bool was_late = node.is_late(now_us);
  if (node.heard_us && !booted) node.interval_us = now_us - *node.heard_us;
  if (booted || was_late) node.interval_us = 0;
  node.heard_us = now_us;
  if (!booted) ++node.heartbeats;
  const bool changed = booted || was_late || node.state != message.state;
  node.state = message.state;
  node.assumed.reset();
  return changed;
}

bool MonitorState::add_pdo(const canopen::Frame& frame, const Message& message, std::int64_t now_us) {
  // A node sends PDOs only in Operational.
  if (message.service == Service::tpdo && message.node_id != 0) {
    assume(message.node_id, canopen::NmtState::operational);
  }
  MonitoredPdo& pdo = pdos_[{message.node_id, message.service == Service::tpdo, message.number}];
  pdo.frames.count();
  pdo.at_us = now_us;
  const bool is_same = pdo.frames.total() > 1 && pdo.frame == frame && has_same_objects(pdo, message);
  pdo.frame = frame;
  pdo.text = message.text;
  pdo.values.clear();
  for (const MessageValue& value : message.values) {
    if (value.text_end < value.text_begin || value.text_end > message.text.size()) continue;
    pdo.values.push_back({value.index, value.sub_index, std::string{value.name},
                          message.text.substr(value.text_begin, value.text_end - value.text_begin),
                          value.quantity != nullptr ? value.quantity->symbol : std::string{}, finite_number_of(value)});
  }
  return !is_same;
}

template <class Update>
void MonitorState::update_rates(Update update) {
  update(frames_);
  update(bits_);
  for (auto& [key, pdo] : pdos_) update(pdo.frames);
  for (auto& [cob_id, rate] : others_) update(rate);
}

void MonitorState::pass(std::int64_t now_us) {
  if (now_us - tick_us_ < second_us) return;
  const double seconds = static_cast<double>(now_us - tick_us_) / second_us;
  update_rates([seconds](Rate& rate) { rate.take(seconds); });
  tick_us_ = now_us;
}

void MonitorState::end(std::int64_t now_us) {
  const double seconds = static_cast<double>(now_us - start_us_) / second_us;
  update_rates([seconds](Rate& rate) { rate.take_all(seconds); });
}

}  // namespace edsc
