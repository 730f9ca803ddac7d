#include "audit/cycle_times.hpp"

#include "audit/checks/sync_check.hpp"

namespace edsc::audit {
namespace {

/// A parameter of a node and the time that it states.
struct Parameter {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::int64_t us = 0;  ///< 0: the parameter does not state a time
};

/// The node with an EDS that produces SYNC with this COB-ID; 0: none, or several.
std::uint8_t producer_of_sync(std::uint32_t cob_id, const AuditState& audit) {
  std::uint8_t producer = 0;
  for (const std::uint8_t id : audit.known) {
    const NodeSettings& settings = audit.nodes[id].settings;
    if (!settings.is_sync_producer || !is_cob_id(settings.sync_id, cob_id)) continue;
    if (producer != 0) return 0;
    producer = id;
  }
  return producer;
}

std::int64_t sync_period(std::uint32_t cob_id, const AuditState& audit) {
  return audit.nodes[producer_of_sync(cob_id, audit)].settings.sync_period_us;
}

/// The event timer, or the SYNCs of the transmission type; none on request and for other events.
Parameter parameter_of(const TpdoSettings& tpdo, std::uint16_t number, std::uint32_t sync_id, const AuditState& audit) {
  const std::uint16_t index = parameters_of(PdoDirection::transmit, number).communication;
  if (tpdo.is_event_driven()) return {index, 5, tpdo.event_us};
  if (tpdo.is_cyclic()) return {index, 2, tpdo.transmission_type * sync_period(sync_id, audit)};
  return {};
}

std::optional<std::int64_t> period_of(const Parameter& parameter) {
  return parameter.us > 0 ? std::optional{parameter.us} : std::nullopt;
}

void put(const Parameter& parameter, Cycle& cycle) {
  if (parameter.us <= 0) return;
  cycle.index = parameter.index;
  cycle.sub_index = parameter.sub_index;
}

}  // namespace

/// Null if there are too many cycles. The distance from a frame before a change of the sender is not a cycle.
Cycle* CycleTimes::count(const CycleKey& key, const SeenMessage& seen, std::int64_t unchanged_since) {
  auto found = cycles_.find(key);
  if (found == cycles_.end()) {
    if (cycles_.size() >= max_cycles) return nullptr;
    found = cycles_.emplace(key, Cycle{}).first;
  }
  Cycle& cycle = found->second;
  cycle.cob_id = canopen::cob_id_of(seen.frame);
  ++cycle.frames;
  if (cycle.last_us && *cycle.last_us >= unchanged_since) cycle.distance.add(seen.at.us - *cycle.last_us);
  cycle.last_us = seen.at.us;
  return &cycle;
}

void CycleTimes::see_sync(const SeenMessage& seen, const AuditState& audit) {
  const std::uint32_t cob_id = canopen::cob_id_of(seen.frame);
  for (const std::uint8_t id : audit.known) {
    if (is_cob_id(audit.nodes[id].settings.sync_id, cob_id)) sync_us_[id] = seen.at.us;
  }
  const std::uint8_t producer = producer_of_sync(cob_id, audit);
  const NodeState& node = audit.nodes[producer];
  const Parameter parameter{0x1006, 0, node.settings.sync_period_us};
  const std::int64_t since = producer == 0 ? audit.times_since : node.unchanged_since();
  Cycle* const cycle = count({0, CycleKind::sync, cob_id, period_of(parameter)}, seen, since);
  if (cycle == nullptr) return;
  put(parameter, *cycle);
  cycle->producer = producer;
}

void CycleTimes::see_heartbeat(const SeenMessage& seen, const AuditState& audit) {
  const std::uint8_t node_id = seen.message.node_id;
  const NodeState& node = audit.nodes[node_id];
  const Parameter parameter{0x1017, 0, node.settings.heartbeat_us};
  Cycle* const cycle = count({node_id, CycleKind::heartbeat, 0, period_of(parameter)}, seen, node.unchanged_since());
  if (cycle != nullptr) put(parameter, *cycle);
}

void CycleTimes::see_tpdo(const SeenMessage& seen, const AuditState& audit) {
  const Message& message = seen.message;
  const NodeState& node = audit.nodes[message.node_id];
  const NodeSettings& settings = node.settings;
  if (message.number == 0 || message.number > settings.tpdos.size()) return;
  const TpdoSettings& tpdo = settings.tpdos[message.number - 1U];
  const Parameter parameter = parameter_of(tpdo, message.number, settings.sync_id, audit);
  const CycleKey key{message.node_id, CycleKind::tpdo, message.number, period_of(parameter)};
  Cycle* const cycle = count(key, seen, node.unchanged_since());
  if (cycle == nullptr) return;
  put(parameter, *cycle);
  const std::optional<std::int64_t> sync_us = sync_us_[message.node_id];
  if (tpdo.is_synchronous() && sync_us) cycle->after_sync.add(seen.at.us - *sync_us);
}

void CycleTimes::see(const SeenMessage& seen, const AuditState& audit) {
  const Message& message = seen.message;
  if (!seen.at.has_time || seen.frame.remote) return;
  switch (message.service) {
    case Service::sync: return see_sync(seen, audit);
    case Service::heartbeat: return message.state ? see_heartbeat(seen, audit) : void();
    case Service::tpdo: return see_tpdo(seen, audit);
    case Service::rpdo:
      (void)count({message.node_id, CycleKind::rpdo, message.number, std::nullopt}, seen, audit.times_since);
      return;
    default: return;
  }
}

}  // namespace edsc::audit
