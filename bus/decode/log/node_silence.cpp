#include "decode/log/node_silence.hpp"

#include <algorithm>

namespace edsc {
namespace {

constexpr std::uint16_t consumer_heartbeat_time = 0x1016, producer_heartbeat_time = 0x1017;
constexpr std::uint16_t first_tpdo = 0x1800;
constexpr std::uint8_t event_timer = 5;
constexpr std::int64_t millisecond = 1000;

/// The shorter of two times, of which 0 is none.
std::int64_t shorter(std::int64_t a, std::int64_t b) { return a == 0 || b == 0 ? std::max(a, b) : std::min(a, b); }

}  // namespace

NodeSilence::NodeSilence(const std::vector<const Device*>& consumers) {
  for (const Device* const device : consumers) {
    const Object* const object = device->find(consumer_heartbeat_time);
    if (object == nullptr) continue;
    for (const Entry& entry : object->entries) {
      if (entry.sub_index == 0 || !entry.default_value) continue;
      const std::uint64_t value = entry.default_value->bits;
      const std::uint64_t node_id = value >> 16 & 0xFF;
      if (node_id == 0 || node_id >= node_ids) continue;
      consumer_us_[node_id] = shorter(consumer_us_[node_id], static_cast<std::int64_t>(value & 0xFFFF) * millisecond);
    }
  }
}

std::optional<std::int64_t> NodeSilence::see(const Message& message, const NodeModel* sender,
                                             std::int64_t microseconds) {
  if (message.service == Service::nmt) end_event_timers(message);
  if (!is_from_node(message) || message.node_id >= node_ids) return std::nullopt;
  const std::optional<std::int64_t> lost = lost_at(message.node_id, microseconds);
  Sender& node = senders_[message.node_id];
  node.last_us = microseconds;
  if (message.service == Service::boot_up) node = {microseconds, 0, false};
  if (message.service == Service::heartbeat) begin_heartbeat(message.node_id, sender);
  if (message.service == Service::tpdo) begin_event_timer(message, sender);
  return lost;
}

std::optional<std::int64_t> NodeSilence::lost_at(std::uint8_t node_id, std::int64_t microseconds) const {
  const Sender& node = senders_[node_id % node_ids];
  if (node.limit_us == 0 || microseconds - node.last_us <= node.limit_us) return std::nullopt;
  return node.last_us + node.limit_us;
}

void NodeSilence::begin_heartbeat(std::uint8_t node_id, const NodeModel* sender) {
  std::int64_t limit = consumer_us_[node_id];
  if (limit == 0 && sender != nullptr) {
    limit = 2 * millisecond * std::int64_t{sender->parameter(producer_heartbeat_time, 0).value_or(0)};
  }
  if (limit == 0) return;
  senders_[node_id].limit_us = limit;
  senders_[node_id].has_heartbeat = true;
}

void NodeSilence::begin_event_timer(const Message& message, const NodeModel* sender) {
  Sender& node = senders_[message.node_id];
  if (node.has_heartbeat || sender == nullptr || message.number == 0) return;
  const auto index = static_cast<std::uint16_t>(first_tpdo + message.number - 1);
  const std::int64_t time = sender->parameter(index, event_timer).value_or(0);
  node.limit_us = shorter(node.limit_us, 2 * millisecond * time);
}

void NodeSilence::end_event_timers(const Message& command) {
  if (!command.command || *command.command == canopen::NmtCommand::start) return;
  for (std::size_t id = 0; id < node_ids; ++id) {
    const bool is_meant = command.node_id == 0 || command.node_id == id;
    if (is_meant && !senders_[id].has_heartbeat) senders_[id].limit_us = 0;
  }
}

}  // namespace edsc
