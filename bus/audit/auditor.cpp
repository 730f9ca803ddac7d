#include "audit/auditor.hpp"

#include <algorithm>
#include <utility>

namespace edsc::audit {

Auditor::Auditor(const Decoder& decoder, const Limits& limits)
    : nmt_{[this](std::uint8_t node_id, const Moment& now) { end_interval(node_id, now); }} {
  audit_.limits = limits;
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) {
    NodeState& node = audit_.nodes[id];
    node.model = decoder.find_model(static_cast<std::uint8_t>(id));
    if (node.model == nullptr) continue;
    node.settings = settings_of(*node.model);
    audit_.known.push_back(static_cast<std::uint8_t>(id));
  }
  if (!audit_.known.empty()) return;
  // Without an EDS, nobody knows which CAN-IDs and nodes are right.
  silence(AuditRule{"can-id-unknown"});
  silence(AuditRule{"node-unknown"});
}

Moment Auditor::moment_of(const LogLine& line) {
  Moment moment{line.number, line.has_time, now_.us};
  if (!line.has_time) return moment;
  if (!times_.first_us()) audit_.findings.begin_at(line.microseconds);
  const std::int64_t back_us = times_.add(line.microseconds);
  moment.us = times_.now_us();
  if (back_us > 0) restart_times(moment, back_us);
  return moment;
}

/// No time is compared with one before. What happened in between is not known.
void Auditor::restart_times(const Moment& now, std::int64_t back_us) {
  audit_.times_since = now.us;
  audit_.findings.add({"log-time"}, now, back_us, [&] {
    return std::pair<std::string, std::string>{"times in order", milliseconds(back_us) + " back"};
  });
  for (std::size_t id = 1; id < AuditState::node_ids; ++id) {
    end_interval(static_cast<std::uint8_t>(id), now_);
    NodeState& node = audit_.nodes[id];
    node.settings_since = audit_.times_since;
    node.state.reset();
    node.ended.clear();
  }
}

void Auditor::check_interface(const LogLine& line) {
  if (line.interface.empty() || line.interface == interface_) return;
  if (interface_.empty()) {
    interface_ = line.interface;
    return;
  }
  audit_.findings.add({"log-interface"}, now_, 0, [&] {
    return std::pair{"frames of " + interface_ + " only", "frames of " + std::string{line.interface} + ", too"};
  });
}

void Auditor::end_interval(std::uint8_t node_id, const Moment& now) {
  heartbeat_.end_interval(node_id, now, audit_);
  sync_.end_interval(node_id, now, audit_);
  pdo_.end_interval(node_id, now, audit_);
}

/// A finished transfer or a boot-up message may have changed what is in force.
void Auditor::read_settings(const Message& message) {
  const bool of_communication = message.index >= 0x1000 && message.index < 0x2000;
  const bool transferred = message.step == TransferStep::finished && of_communication;
  if (!transferred && message.service != Service::boot_up) return;
  NodeState& node = audit_.sender(message);
  if (node.model == nullptr) return;
  NodeSettings settings = settings_of(*node.model);
  // Each write to 1017h starts the heartbeat again.
  const bool restarts = message.download && message.index == 0x1017 && message.step == TransferStep::finished;
  if (settings == node.settings && !restarts) return;
  end_interval(message.node_id, now_);
  node.settings = std::move(settings);
  node.settings_since = now_.us;
}

void Auditor::see(const LogLine& line, const Message& message) {
  now_ = moment_of(line);
  ++frames_;
  check_interface(line);
  const SeenMessage seen{line.frame, message, now_};
  incident_.see(seen, audit_);
  bus_.see(seen, audit_);
  heartbeat_.see(seen, audit_);
  guarding_.see(seen, audit_);
  sdo_.see(seen, audit_);  // before a boot-up message ends the state in which the node was asked
  nmt_.see(seen, audit_);
  sync_.see(seen, audit_);
  pdo_.see(seen, audit_);
  emergency_.see(seen, audit_);
  lss_.see(seen, audit_);
  cycle_times_.see(seen, audit_);
  if (network_times_) network_times_->see(seen);
  NodeState& node = audit_.sender(message);
  if (!node.first_seen && is_from_node(message) && !line.frame.remote) node.first_seen = now_;
  read_settings(message);
}

void Auditor::finish() {
  incident_.finish(now_, audit_);
  nmt_.finish(now_, audit_);
  heartbeat_.finish(now_, audit_);
  guarding_.finish(now_, audit_);
  sync_.finish(now_, audit_);
  pdo_.finish(now_, audit_);
  emergency_.finish(audit_);
  sdo_.finish(now_, audit_);
  lss_.finish(now_, audit_);
  bus_.finish(now_, audit_);
}

Totals Auditor::totals() const {
  const auto nodes =
      std::ranges::count_if(audit_.nodes, [](const NodeState& node) { return node.first_seen.has_value(); });
  return {frames_,
          times_.first_us().has_value(),
          now_.us,
          static_cast<std::size_t>(nodes),
          bus_.mean_load(now_, audit_.limits),
          bus_.max_load()};
}

}  // namespace edsc::audit
