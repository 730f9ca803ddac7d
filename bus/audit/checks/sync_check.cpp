#include "audit/checks/sync_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::audit {
namespace {

using canopen::NmtState;

/// The node that produces SYNC with this COB-ID; 0 if none of the known does.
std::uint8_t find_producer(std::uint32_t cob_id, const Moment& now, AuditState& audit) {
  std::uint8_t producer = 0;
  for (const std::uint8_t id : audit.known) {
    const NodeSettings& settings = audit.nodes[id].settings;
    if (!settings.is_sync_producer || !is_cob_id(settings.sync_id, cob_id)) continue;
    if (producer != 0) {
      audit.findings.add({"sync-producers", id, 0x1005}, now, 0, [&] {
        return std::pair<std::string, std::string>{"one producer", fmt::format("also node {}", unsigned{producer})};
      });
      return 0;
    }
    producer = id;
  }
  return producer;
}

Subject subject_of(AuditRule rule, std::uint8_t producer, std::uint16_t index, std::uint32_t id) {
  return {rule, producer, index, 0, id & 0x1FFF'FFFF, (id >> 29 & 1) != 0};
}

/// A producer sends in Pre-operational and Operational, the first SYNC within a period.
void check_silence(std::uint8_t producer, std::int64_t last_us, const Moment& now, AuditState& audit) {
  const NodeState& node = audit.nodes[producer];
  const std::int64_t period = node.settings.sync_period_us;
  const bool sends = node.state == NmtState::pre_operational || node.state == NmtState::operational;
  if (!node.settings.is_sync_producer || period == 0 || !sends || !node.first_seen || !now.has_time) return;
  const std::int64_t gap = now.us - std::max({last_us, node.unchanged_since(), node.first_seen->us});
  if (gap <= period + audit.limits.slack(period)) return;
  const Subject subject = subject_of("sync-period", producer, 0x1006, node.settings.sync_id);
  audit.findings.add(subject, now, gap - period, [&] {
    return std::pair{"every " + milliseconds(period), "none for " + milliseconds(gap)};
  });
}

}  // namespace

void SyncCheck::check_period(std::uint32_t id, const Sync& sync, const Moment& now, AuditState& audit) {
  const NodeState& node = audit.nodes[sync.producer];
  const std::int64_t period = node.settings.sync_period_us;
  if (sync.producer == 0 || period == 0 || !now.has_time || node.state == NmtState::stopped) return;
  if (sync.last_us.value_or(-1) < node.unchanged_since()) return check_silence(sync.producer, 0, now, audit);
  const std::int64_t gap = now.us - *sync.last_us;
  const std::int64_t error = std::abs(gap - period);
  if (error <= audit.limits.slack(period)) return;
  audit.findings.add(subject_of("sync-period", sync.producer, 0x1006, id), now, error, [&] {
    return std::pair{"every " + milliseconds(period), "after " + milliseconds(gap)};
  });
}

void SyncCheck::check_counter(std::uint32_t id, const Sync& sync, const SeenMessage& seen, AuditState& audit) {
  const NodeState& node = audit.nodes[sync.producer];
  if (sync.producer == 0) return;
  const std::uint8_t overflow = node.settings.sync_overflow.value_or(0);
  const std::int16_t counter = seen.message.counter;
  std::string expected;
  if (overflow == 0) {
    if (counter >= 0) expected = "no counter";
  } else if (counter < 1 || counter > overflow) {
    expected = fmt::format("1 to {}", unsigned{overflow});
  } else if (sync.counter && sync.last_us && *sync.last_us >= node.unchanged_since()) {
    const int next = *sync.counter >= overflow ? 1 : *sync.counter + 1;
    if (counter != next) expected = std::to_string(next);
  }
  if (expected.empty()) return;
  audit.findings.add(subject_of("sync-counter", sync.producer, 0x1019, id), seen.at, 0, [&] {
    return std::pair{expected, counter < 0 ? std::string{"no counter"} : std::to_string(counter)};
  });
}

void SyncCheck::see(const SeenMessage& seen, AuditState& audit) {
  if (seen.message.service != Service::sync || seen.frame.remote || seen.frame.size > 1) return;
  const std::uint32_t id = canopen::cob_id_of(seen.frame);
  Sync& sync = syncs_[id];
  sync.producer = find_producer(id, seen.at, audit);
  check_period(id, sync, seen.at, audit);
  check_counter(id, sync, seen, audit);
  if (seen.at.has_time) sync.last_us = seen.at.us;
  sync.counter.reset();
  if (seen.message.counter >= 0) sync.counter = static_cast<std::uint8_t>(seen.message.counter);
}

void SyncCheck::end_interval(std::uint8_t node_id, const Moment& now, AuditState& audit) {
  const NodeSettings& settings = audit.nodes[node_id].settings;
  if (!settings.is_sync_producer) return;
  const auto found = syncs_.find(settings.sync_id);
  const std::int64_t last_us = found == syncs_.end() ? 0 : found->second.last_us.value_or(0);
  check_silence(node_id, last_us, now, audit);
}

void SyncCheck::finish(const Moment& end, AuditState& audit) {
  for (const std::uint8_t id : audit.known) end_interval(id, end, audit);
}

}  // namespace edsc::audit
