#include "audit/checks/guarding_check.hpp"

#include <canopen/nmt/error_control.hpp>
#include <string>
#include <utility>

namespace edsc::audit {
namespace {

std::string toggle_text(bool toggle) { return toggle ? "toggle 1" : "toggle 0"; }

}  // namespace

void GuardingCheck::check_silence(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  Node& node = nodes_[node_id];
  if (!node.asked_us) return;
  const std::int64_t waited = now.us - *node.asked_us;
  if (waited < reaction_us) return;
  node.asked_us.reset();
  audit.findings.add({"guarding-response", node_id}, now, waited, [&] {
    return std::pair{"within " + milliseconds(reaction_us), "none for " + milliseconds(waited)};
  });
}

/// A node that boots, was never seen, or produces heartbeats (CiA 301, 7.2.8.3.2) does not respond.
void GuardingCheck::request(const SeenMessage& seen, AuditState& audit) {
  const std::uint8_t node_id = seen.message.node_id;
  const NodeState& state = audit.nodes[node_id];
  check_silence(node_id, seen.at, audit);
  const bool responds =
      state.first_seen && state.state != canopen::NmtState::initialisation && state.settings.heartbeat_us == 0;
  if (seen.at.has_time && responds && !nodes_[node_id].asked_us) nodes_[node_id].asked_us = seen.at.us;
}

void GuardingCheck::response(const SeenMessage& seen, AuditState& audit) {
  const auto message = canopen::error_control_message(seen.frame);
  if (!message) return;
  Node& node = nodes_[seen.message.node_id];
  node.asked_us.reset();
  const std::optional<bool> expected = std::exchange(node.toggle, !message->toggle);
  if (expected.value_or(message->toggle) == message->toggle) return;
  audit.findings.add({"guarding-toggle", seen.message.node_id}, seen.at, 0, [&] {
    return std::pair{toggle_text(*expected), toggle_text(message->toggle)};
  });
}

void GuardingCheck::see(const SeenMessage& seen, AuditState& audit) {
  switch (seen.message.service) {
    case Service::boot_up: nodes_[seen.message.node_id] = {false, std::nullopt}; return;
    // A response with toggle 0 looks like a heartbeat if the log does not have the remote frames.
    case Service::heartbeat: nodes_[seen.message.node_id].toggle.reset(); return;
    case Service::guarding: return seen.frame.remote ? request(seen, audit) : response(seen, audit);
    default: return;
  }
}

void GuardingCheck::finish(const Moment& end, AuditState& audit) {
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) check_silence(static_cast<std::uint8_t>(id), end, audit);
}

}  // namespace edsc::audit
