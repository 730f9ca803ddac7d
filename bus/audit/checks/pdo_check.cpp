#include "audit/checks/pdo_check.hpp"

#include <fmt/format.h>

#include <utility>

#include "audit/checks/sync_check.hpp"
#include "text/counted.hpp"

namespace edsc::audit {
namespace {

Subject subject_of(AuditRule rule, std::uint8_t node_id, std::size_t number, bool transmit = true) {
  const PdoDirection direction = transmit ? PdoDirection::transmit : PdoDirection::receive;
  return {rule, node_id, parameters_of(direction, static_cast<std::uint16_t>(number)).communication};
}

std::string after_syncs(std::uint32_t count) { return "after " + counted(count, "SYNC"); }

void check_event_timer(std::uint8_t node_id, std::size_t number, const TpdoSettings& settings, std::int64_t gap,
                       const Moment& now, AuditState& audit) {
  if (!settings.is_sent || !settings.is_event_driven() || settings.event_us == 0) return;
  const std::int64_t longest = std::max(settings.event_us, settings.inhibit_us);
  if (gap <= longest + audit.limits.slack(longest)) return;
  audit.findings.add(subject_of("pdo-event-timer", node_id, number), now, gap, [&] {
    return std::pair{"at most " + milliseconds(longest), "none for " + milliseconds(gap)};
  });
}

void check_inhibit_time(const SeenMessage& seen, const TpdoSettings& settings, std::int64_t gap, AuditState& audit) {
  if (!settings.is_event_driven() || gap >= settings.inhibit_us - audit.limits.slack(settings.inhibit_us)) return;
  const Subject subject = subject_of("pdo-inhibit-time", seen.message.node_id, seen.message.number);
  audit.findings.add(subject, seen.at, -gap, [&] {
    return std::pair{"at least " + milliseconds(settings.inhibit_us), "after " + milliseconds(gap)};
  });
}

void check_window(const SeenMessage& seen, const NodeState& node, std::int64_t after_sync, AuditState& audit) {
  const std::int64_t window = node.settings.sync_window_us;
  if (window == 0 || after_sync <= window + audit.limits.slack(window)) return;
  const Subject subject = subject_of("pdo-sync-window", seen.message.node_id, seen.message.number);
  audit.findings.add(subject, seen.at, after_sync, [&] {
    return std::pair{fmt::format("within {} of SYNC", milliseconds(window)), "after " + milliseconds(after_sync)};
  });
}

}  // namespace

void PdoCheck::count_sync(const SeenMessage& seen, AuditState& audit) {
  if (seen.message.problem) return;  // nodes ignore it
  for (const std::uint8_t id : audit.known) {
    if (!is_cob_id(audit.nodes[id].settings.sync_id, canopen::cob_id_of(seen.frame))) continue;
    ++nodes_[id].syncs;
    if (seen.at.has_time) nodes_[id].sync_us = seen.at.us;
  }
}

/// Length and state; a TPDO must have the length of its mapping, an RPDO may be longer.
void PdoCheck::check_frame(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  const bool transmit = message.service == Service::tpdo;
  const std::size_t bytes = message.pdo->multiplexed ? classical_can.bytes : bytes_for(message.pdo->bits);
  if (transmit ? seen.frame.size != bytes : seen.frame.size < bytes) {
    const Subject subject = subject_of("pdo-length", message.node_id, message.number, transmit);
    audit.findings.add(subject, seen.at, 0, [&] {
      return std::pair{counted(bytes, "byte"), counted(unsigned{seen.frame.size}, "byte")};
    });
  }
  const NodeState& node = audit.sender(message);
  if (!transmit || node.may_be(canopen::NmtState::operational, seen.at)) return;
  audit.findings.add(subject_of("pdo-state", message.node_id, message.number), seen.at, 0, [&] {
    return std::pair<std::string, std::string>{to_text(canopen::NmtState::operational), to_text(*node.state)};
  });
}

void PdoCheck::check_tpdo(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  const NodeState& node = audit.sender(message);
  Node& sent = nodes_[message.node_id % AuditState::node_ids];
  const std::size_t at = message.number - 1U;
  if (at >= node.settings.tpdos.size()) return;
  if (at >= sent.tpdos.size()) sent.tpdos.resize(at + 1);
  const TpdoSettings& settings = node.settings.tpdos[at];
  Tpdo& tpdo = sent.tpdos[at];
  const std::uint32_t syncs = sent.syncs - tpdo.last_sync;
  // A node may ignore a remote frame: a TPDO that is due is not the response.
  const bool due = settings.is_cyclic() && syncs == settings.transmission_type;
  const bool requested = tpdo.requests > 0 && !due;
  if (requested) --tpdo.requests;
  // The remote frame may be before the log.
  const bool log_begins = seen.at.has_time && seen.at.us - audit.times_since < reaction_us;
  if (settings.is_requested() && !requested && !log_begins) {
    audit.findings.add(subject_of("pdo-not-requested", message.node_id, message.number), seen.at, 0, [] {
      return std::pair<std::string, std::string>{"a remote frame before", "none"};
    });
  }
  if (seen.at.has_time && node.is_operational()) {
    const std::int64_t from = std::max(tpdo.last_us.value_or(0), node.unchanged_since());
    check_event_timer(message.node_id, message.number, settings, seen.at.us - from, seen.at, audit);
    if (tpdo.last_event_us && !requested) check_inhibit_time(seen, settings, seen.at.us - *tpdo.last_event_us, audit);
    if (settings.is_synchronous() && sent.sync_us && !requested) {
      check_window(seen, node, seen.at.us - *sent.sync_us, audit);
    }
  }
  if (settings.is_cyclic() && node.is_operational() && tpdo.sent && !requested && !due) {
    audit.findings.add(subject_of("pdo-sync-cycle", message.node_id, message.number), seen.at, syncs, [&] {
      return std::pair{after_syncs(settings.transmission_type),
                       syncs == 0 ? std::string{"twice after a SYNC"} : after_syncs(syncs)};
    });
  }
  if (seen.at.has_time) tpdo.last_us = seen.at.us;
  if (requested) return;
  tpdo.sent = true;
  tpdo.last_sync = sent.syncs;
  tpdo.last_event_us = tpdo.last_us;
}

/// Each remote frame for a TPDO that is sent on request only has a response.
void PdoCheck::request(const SeenMessage& seen, AuditState& audit) {
  const std::size_t at = seen.message.number - 1U;
  Node& node = nodes_[seen.message.node_id % AuditState::node_ids];
  const std::vector<TpdoSettings>& settings = audit.sender(seen.message).settings.tpdos;
  if (node.tpdos.size() <= at) node.tpdos.resize(at + 1);
  const bool on_request_only = at < settings.size() && settings[at].is_requested();
  node.tpdos[at].requests = on_request_only ? node.tpdos[at].requests + 1 : 1;
}

void PdoCheck::see(const SeenMessage& seen, AuditState& audit) {
  const Message& message = seen.message;
  if (message.service == Service::sync) return count_sync(seen, audit);
  if (message.pdo == nullptr) return;
  if (seen.frame.remote) return request(seen, audit);
  check_frame(seen, audit);
  if (message.service == Service::tpdo) check_tpdo(seen, audit);
}

/// A TPDO that is not sent any more does not have a frame at which it could be checked.
void PdoCheck::end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  const NodeState& state = audit.nodes[node_id];
  Node& node = nodes_[node_id];
  const std::size_t count = state.is_operational() && state.first_seen ? state.settings.tpdos.size() : 0;
  node.tpdos.resize(std::max(node.tpdos.size(), count));
  for (std::size_t at = 0; at < count; ++at) {
    const TpdoSettings& settings = state.settings.tpdos[at];
    const Tpdo& tpdo = node.tpdos[at];
    if (now.has_time) {
      const std::int64_t from = std::max(tpdo.last_us.value_or(0), state.unchanged_since());
      check_event_timer(node_id, at + 1, settings, now.us - from, now, audit);
    }
    // The first one may wait for the start value of the SYNC counter.
    const std::uint32_t first = tpdo.sent ? 0 : 1U + state.settings.sync_overflow.value_or(0);
    const std::uint32_t syncs = node.syncs - tpdo.last_sync;
    if (!settings.is_sent || !settings.is_cyclic() || syncs <= settings.transmission_type + first) continue;
    audit.findings.add(subject_of("pdo-sync-cycle", node_id, at + 1), now, syncs, [&] {
      return std::pair{after_syncs(settings.transmission_type), "none " + after_syncs(syncs)};
    });
  }
  node.tpdos.assign(node.tpdos.size(), {});
  node.syncs = 0;
}

void PdoCheck::finish(const Moment& end, AuditState& audit) {
  for (const std::uint8_t id : audit.known) end_interval(id, end, audit);
}

}  // namespace edsc::audit
