#include "audit/checks/nmt_check.hpp"

#include <fmt/format.h>

#include <canopen/nmt/error_control.hpp>
#include <utility>

#include "values/nmt_text.hpp"

namespace edsc::audit {
namespace {

using canopen::NmtState;

/// A node leaves Operational by itself after an error (1029h), and enters it by itself if 1F80h allows.
bool may_change_itself(const NodeState& node, NmtState reported, const Moment& now) {
  constexpr std::int64_t recent_us = 5'000'000;
  if (node.state == NmtState::operational) {
    return node.last_emcy_us && now.has_time && now.us - *node.last_emcy_us < recent_us;
  }
  return node.state == NmtState::pre_operational && reported == NmtState::operational && node.settings.starts_itself;
}

/// Whether the node that LSS has given another node-ID boots with that one.
bool boots_as_another(const NodeState& node, const AuditState& audit) {
  const NodeState& other = audit.nodes[audit.lss_node_id];
  return audit.lss_node_id != 0 && other.first_seen && other.state != NmtState::initialisation &&
         other.state_since.us >= node.state_since.us;
}

/// Whether LSS has given this node-ID to a node that has just been reset: it boots with this one (CiA 305).
bool is_new_node_id(std::uint8_t node_id, const AuditState& audit) {
  const auto boots = [&](const NodeState& node) {
    return node.first_seen && node.state == NmtState::initialisation &&
           node.state_since.us >= audit.nodes[node_id].state_since.us;
  };
  return audit.lss_node_id == node_id && std::ranges::any_of(audit.nodes, boots);
}

/// Whether a command may not apply to the node: the master is exempt from its own commands, and a node without an EDS
/// may be the master.
bool may_ignore(std::uint8_t node_id, bool is_for_all, const AuditState& audit) {
  const NodeState& node = audit.nodes[node_id];
  return audit.nmt_master == node_id || node.settings.is_nmt_master || (node.model == nullptr && is_for_all);
}

void check_boot_time(std::uint8_t node_id, const NodeState& node, const Moment& now, AuditState& audit) {
  if (node.state != NmtState::initialisation || !node.first_seen || !now.has_time) return;
  if (boots_as_another(node, audit)) return;
  const std::int64_t waited = now.us - node.state_since.us;
  if (waited <= max_boot_us) return;
  audit.findings.add({"nmt-boot-up", node_id}, now, waited, [&] {
    return std::pair{fmt::format("within {} of the reset command", milliseconds(max_boot_us)),
                     "none for " + milliseconds(waited)};
  });
}

}  // namespace

void NmtCheck::change(std::uint8_t node_id, std::optional<NmtState> state, const Moment& now, AuditState& audit) {
  NodeState& node = audit.nodes[node_id];
  before_change_(node_id, now);
  std::erase_if(node.ended, [&](const EndedState& one) { return one.state == node.state; });
  node.ended.push_back({std::exchange(node.state, state), now.us});
  node.state_since = now;
}

void NmtCheck::command(const SeenMessage& seen, AuditState& audit) {
  const auto* const row = seen.message.problem
                              ? nullptr
                              : find_nmt_command(&NmtCommandText::command, canopen::NmtCommand{seen.frame.data[0]});
  if (row == nullptr || seen.frame.size != 2 || seen.message.node_id > 127) {
    audit.findings.add({"nmt-command", 0}, seen.at, 0, [&] {
      return std::pair<std::string, std::string>{"a command and a node-ID", seen.message.text};
    });
    return;
  }
  for (std::size_t id = 1; id < audit.nodes.size(); ++id) {
    const auto node_id = static_cast<std::uint8_t>(id);
    if (seen.message.node_id != 0 && seen.message.node_id != node_id) continue;
    NodeState& node = audit.nodes[id];
    if (may_ignore(node_id, seen.message.node_id == 0, audit)) {
      node.may_boot = node.may_boot || row->leads_to == NmtState::initialisation;
      change(node_id, std::nullopt, seen.at, audit);
      continue;
    }
    // Before its boot-up message a node does not hear anything.
    if (node.state == NmtState::initialisation || (node.state == row->leads_to && node.state)) continue;
    change(node_id, row->leads_to, seen.at, audit);
  }
}

void NmtCheck::boot_up(const SeenMessage& seen, AuditState& audit) {
  const std::uint8_t node_id = seen.message.node_id;
  NodeState& node = audit.nodes[node_id];
  if (node.state == NmtState::initialisation) {
    check_boot_time(node_id, node, seen.at, audit);
  } else if (!node.may_boot && !is_new_node_id(node_id, audit) && node.first_seen &&
             (node.state || node.first_seen->us >= audit.times_since)) {
    audit.findings.add({"nmt-reset", node_id}, seen.at, 0, [&] {
      return std::pair<std::string, std::string>{
          "a reset command before", fmt::format("the node was {}", node.state ? to_text(*node.state) : "on the bus")};
    });
  }
  change(node_id, NmtState::initialisation, seen.at, audit);
  node.may_boot = false;
  node.ended.clear();
  change(node_id, NmtState::pre_operational, seen.at, audit);
  if (node.settings.starts_itself) node.state.reset();  // it may be Operational at once
}

void NmtCheck::report(const SeenMessage& seen, AuditState& audit) {
  const std::uint8_t node_id = seen.message.node_id;
  const auto reported = canopen::error_control_message(seen.frame);
  if (!reported) {
    if (seen.frame.remote || seen.frame.size != 1) return;
    audit.findings.add({"nmt-state", node_id}, seen.at, 0, [&] {
      return std::pair<std::string, std::string>{"an NMT state", seen.message.text};
    });
    return;
  }
  const NodeState& node = audit.nodes[node_id];
  if (node.state == reported->state) return;
  if (node.state && node.may_be(reported->state, seen.at)) return;
  if (node.state && !may_change_itself(node, reported->state, seen.at)) {
    audit.findings.add({"nmt-state", node_id}, seen.at, 0, [&] {
      const bool booting = *node.state == NmtState::initialisation;
      return std::pair<std::string, std::string>{booting ? "a boot-up message first" : to_text(*node.state),
                                                 to_text(reported->state)};
    });
  }
  change(node_id, reported->state, seen.at, audit);
}

void NmtCheck::see(const SeenMessage& seen, AuditState& audit) {
  switch (seen.message.service) {
    case Service::nmt: return command(seen, audit);
    case Service::boot_up: return boot_up(seen, audit);
    case Service::heartbeat:
    case Service::guarding: return report(seen, audit);
    default: break;
  }
  const bool active = seen.message.service == Service::emcy || seen.message.service == Service::sdo;
  if (!active || !is_from_node(seen.message)) return;
  const std::uint8_t node_id = seen.message.node_id;
  const NodeState& node = audit.nodes[node_id];
  const bool stopped = node.state == NmtState::stopped && !node.may_be(NmtState::operational, seen.at) &&
                       !node.may_be(NmtState::pre_operational, seen.at);
  if (!stopped) return;
  audit.findings.add({"stopped-service", node_id}, seen.at, 0, [&] {
    return std::pair<std::string, std::string>{"NMT and error control only", row_of(seen.message.service).label};
  });
}

void NmtCheck::finish(const Moment& end, AuditState& audit) {
  for (std::size_t id = 1; id < audit.nodes.size(); ++id) {
    check_boot_time(static_cast<std::uint8_t>(id), audit.nodes[id], end, audit);
  }
}

}  // namespace edsc::audit
