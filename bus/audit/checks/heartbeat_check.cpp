#include "audit/checks/heartbeat_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::audit {

using canopen::NmtState;

void HeartbeatCheck::check_late(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  const NodeState& node = audit.nodes[node_id];
  Producer& producer = producers_[node_id];
  const std::int64_t period = node.settings.heartbeat_us;
  // Between a reset command and the boot-up message a node is silent.
  if (period == 0 || !node.first_seen || node.state == NmtState::initialisation || producer.reported) return;
  const std::int64_t from = std::max(producer.last_us.value_or(node.first_seen->us), node.settings_since);
  const std::int64_t gap = now.us - from;
  if (gap <= period + audit.limits.slack(period)) return;
  producer.reported = true;
  audit.findings.add({"heartbeat-late", node_id, 0x1017}, now, gap, [&] {
    return std::pair{"every " + milliseconds(period), "none for " + milliseconds(gap)};
  });
}

/// Only of two heartbeats with the same state and without a command in between.
void HeartbeatCheck::check_early(const SeenMessage& seen, AuditState& audit) {
  const std::uint8_t node_id = seen.message.node_id;
  const NodeState& node = audit.nodes[node_id];
  const Producer& producer = producers_[node_id];
  const std::int64_t period = node.settings.heartbeat_us;
  if (period == 0 || !producer.last_us || producer.state == 0 || producer.state != (seen.frame.data[0] & 0x7F)) return;
  if (*producer.last_us < node.unchanged_since()) return;
  const std::int64_t gap = seen.at.us - *producer.last_us;
  if (gap >= period - audit.limits.slack(period)) return;
  audit.findings.add({"heartbeat-early", node_id, 0x1017}, seen.at, -gap, [&] {
    return std::pair{"every " + milliseconds(period), "after " + milliseconds(gap)};
  });
}

void HeartbeatCheck::check_consumers(std::uint8_t producer, const Moment& now, AuditState& audit) {
  if (!producers_[producer].last_us) return;
  const std::int64_t last = *producers_[producer].last_us;
  for (const std::uint8_t id : audit.known) {
    const NodeState& node = audit.nodes[id];
    const bool reports = node.first_seen && (node.settings.emcy_id >> 31) == 0 &&
                         (node.state == NmtState::operational || node.state == NmtState::pre_operational);
    if (!reports || last < node.unchanged_since()) continue;
    for (const ConsumedHeartbeat& consumed : node.settings.consumed) {
      if (consumed.producer != producer) continue;
      const std::int64_t slack = audit.limits.slack(consumed.us);
      const std::int64_t gap = now.us - last;
      if (gap <= consumed.us + slack + reaction_us + node.settings.emcy_inhibit_us) continue;
      if (node.last_heartbeat_error_us.value_or(-1) >= last + consumed.us - slack) continue;
      audit.findings.add({"heartbeat-consumer", id, 0x1016, consumed.sub_index}, now, gap, [&] {
        return std::pair{fmt::format("EMCY 8130h {} after the last heartbeat of node {}", milliseconds(consumed.us),
                                     unsigned{producer}),
                         fmt::format("none, without a heartbeat for {}", milliseconds(gap))};
      });
    }
  }
}

void HeartbeatCheck::see(const SeenMessage& seen, AuditState& audit) {
  const Service service = seen.message.service;
  if (service != Service::heartbeat && service != Service::boot_up) return;
  if (!seen.at.has_time || seen.frame.remote || seen.frame.size != 1) return;
  const std::uint8_t node_id = seen.message.node_id;
  Producer& producer = producers_[node_id];
  if (service == Service::heartbeat) {
    check_late(node_id, seen.at, audit);
    check_early(seen, audit);
  }
  check_consumers(node_id, seen.at, audit);
  producer = {seen.at.us, static_cast<std::uint8_t>(seen.frame.data[0] & 0x7F), false};
}

void HeartbeatCheck::end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  if (now.has_time) check_late(node_id, now, audit);
}

void HeartbeatCheck::finish(const Moment& end, AuditState& audit) {
  if (!end.has_time) return;
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) {
    check_late(static_cast<std::uint8_t>(id), end, audit);
    check_consumers(static_cast<std::uint8_t>(id), end, audit);
  }
}

}  // namespace edsc::audit
