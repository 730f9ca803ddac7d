#include "audit/checks/incident_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::audit {
namespace {

using Texts = std::pair<std::string, std::string>;

constexpr std::int64_t after_us = 1'000'000;           ///< in which what follows from an incident is found
constexpr std::int64_t late_response_us = 10'000'000;  ///< after the request
}  // namespace

std::int64_t IncidentCheck::period_of(std::uint8_t node_id, const AuditState& audit) const {
  const NodeState& node = audit.nodes[node_id];
  return audit.known.empty() ? senders_[node_id].distance_us : node.settings.heartbeat_us;
}

/// All nodes with a heartbeat miss two or more of theirs, and no other frame is in the log: two nodes at least.
void IncidentCheck::check_gap(const Moment& now, AuditState& audit) {
  const std::int64_t from = last_us_.value_or(now.us);
  unsigned producers = 0;
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) {
    const std::int64_t period = period_of(static_cast<std::uint8_t>(id), audit);
    const bool is_there = senders_[id].heartbeat_us && audit.nodes[id].state != canopen::NmtState::initialisation;
    if (period == 0 || !is_there) continue;
    if (now.us - from <= 2 * period) return;
    ++producers;
  }
  if (producers < 2) return;
  gap_from_us_ = from;
  gap_until_us_ = now.us;
  audit.incidents.add({"log-gap", 0, from, now.us + after_us});
  audit.findings.add({"log-gap"}, now, now.us - from, [&] {
    return Texts{"frames of the nodes", "none for " + milliseconds(now.us - from)};
  });
}

void IncidentCheck::check_node(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  const Sender& sender = senders_[node_id];
  const NodeState& node = audit.nodes[node_id];
  const std::int64_t period = period_of(node_id, audit);
  if (period == 0 || !sender.last_us || !sender.heartbeat_us || node.state == canopen::NmtState::initialisation) return;
  const std::int64_t from = std::max({*sender.last_us, node.settings_since, audit.times_since});
  const std::int64_t silence = now.us - from;
  const std::int64_t in_gap = gap_from_us_ >= *sender.last_us ? gap_until_us_ - gap_from_us_ : 0;
  if (silence - in_gap <= 2 * period + period / 2) return;
  audit.incidents.add({"node-lost", node_id, from, now.us + after_us});
  audit.findings.add({"node-lost", node_id}, now, silence, [&] {
    return Texts{"a heartbeat every " + milliseconds(period), "no frame for " + milliseconds(silence)};
  });
}

void IncidentCheck::check_client(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  if (message.service != Service::sdo || message.channel >= AuditState::node_ids) return;
  std::int64_t& asked = asked_us_[message.channel];
  const bool gives_up =
      message.from_client && message.step == TransferStep::aborted && message.abort_code == timeout_abort;
  if (gives_up) {
    const std::int64_t waited = seen.at.us - asked;
    audit.incidents.add({"sdo-gives-up", message.node_id, asked, seen.at.us + late_response_us});
    audit.findings.add({"sdo-gives-up", message.node_id}, seen.at, -waited, [&] {
      return Texts{"a client that waits for the response", fmt::format("abort after {}", milliseconds(waited))};
    });
  } else if (message.from_client) {
    asked = seen.at.us;
  }
}

void IncidentCheck::see(const SeenMessage& seen, AuditState& audit) {
  if (!seen.at.has_time || seen.message.service == Service::error_frame) return;
  check_gap(seen.at, audit);
  check_client(seen, audit);
  last_us_ = seen.at.us;
  if (!is_from_node(seen.message) || seen.frame.remote) return;
  const std::uint8_t node_id = seen.message.node_id;
  check_node(node_id, seen.at, audit);
  Sender& sender = senders_[node_id];
  sender.last_us = seen.at.us;
  if (seen.message.service == Service::boot_up) sender.heartbeat_us.reset();
  if (seen.message.service != Service::heartbeat) return;
  if (sender.heartbeat_us) sender.distance_us = seen.at.us - *sender.heartbeat_us;
  sender.heartbeat_us = seen.at.us;
}

void IncidentCheck::finish(const Moment& end, AuditState& audit) {
  if (!end.has_time) return;
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) check_node(static_cast<std::uint8_t>(id), end, audit);
}

}  // namespace edsc::audit
