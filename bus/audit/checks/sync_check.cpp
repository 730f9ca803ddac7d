#include "audit/checks/sync_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::audit {
namespace {

/// The node that produces SYNC with this COB-ID; 0 if none of the known does.
std::uint8_t find_producer(std::uint32_t cob_id, const Moment& now, AuditState& audit) {
  std::uint8_t producer = 0;
  for (const std::uint8_t id : audit.known) {
    const NodeSettings& settings = audit.nodes[id].settings;
    if (!settings.is_sync_producer || !is_cob_id(settings.sync_id, cob_id)) continue;
    if (producer != 0) {
      audit.findings.add({RuleId::sync_producers, id, 0x1005}, now, 0, [&] {
        return std::pair<std::string, std::string>{"one producer", fmt::format("also node {}", unsigned{producer})};
      });
      return 0;
    }
    producer = id;
  }
  return producer;
}

}  // namespace

void SyncCheck::judge_period(std::uint32_t id, const Sync& sync, const Moment& now, bool ended, AuditState& audit) {
  const NodeState& node = audit.nodes[sync.producer];
  const std::int64_t period = node.settings.sync_period_us;
  if (sync.producer == 0 || period == 0 || !sync.last_us || !now.has_time) return;
  if (*sync.last_us < node.unchanged_since() || node.state == canopen::NmtState::stopped) return;
  const std::int64_t gap = now.us - *sync.last_us;
  const std::int64_t error = ended ? std::max<std::int64_t>(gap - period, 0) : std::abs(gap - period);
  if (error <= audit.limits.slack(period)) return;
  const Subject subject{RuleId::sync_period, sync.producer, 0x1006, 0, id & 0x1FFF'FFFF, (id >> 29 & 1) != 0};
  audit.findings.add(subject, now, error, [&] {
    return std::pair{"every " + milliseconds(period), (ended ? "none for " : "after ") + milliseconds(gap)};
  });
}

void SyncCheck::judge_counter(std::uint32_t id, const Sync& sync, const SeenMessage& seen, AuditState& audit) {
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
  const Subject subject{RuleId::sync_counter, sync.producer, 0x1019, 0, id & 0x1FFF'FFFF, (id >> 29 & 1) != 0};
  audit.findings.add(subject, seen.at, 0, [&] {
    return std::pair{expected, counter < 0 ? std::string{"no counter"} : std::to_string(counter)};
  });
}

void SyncCheck::see(const SeenMessage& seen, AuditState& audit) {
  if (seen.message.service != Service::sync || seen.frame.remote || seen.frame.size > 1) return;
  const std::uint32_t id = canopen::cob_id_of(seen.frame);
  Sync& sync = syncs_[id];
  sync.producer = find_producer(id, seen.at, audit);
  judge_period(id, sync, seen.at, false, audit);
  judge_counter(id, sync, seen, audit);
  if (seen.at.has_time) sync.last_us = seen.at.us;
  sync.counter.reset();
  if (seen.message.counter >= 0) sync.counter = static_cast<std::uint8_t>(seen.message.counter);
}

void SyncCheck::finish(const Moment& end, AuditState& audit) {
  for (const auto& [id, sync] : syncs_) judge_period(id, sync, end, true, audit);
}

}  // namespace edsc::audit
