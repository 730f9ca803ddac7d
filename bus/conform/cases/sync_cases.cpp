/// SYNC (CiA 301, 7.2.5): producer and consumer, with and without counter. The COB-ID of TIME (7.5.2.15).
#include <fmt/format.h>

#include <canopen/sync/sync.hpp>

#include "conform/cases/shared/entry_values.hpp"
#include "conform/cases/shared/setup.hpp"
#include "conform/cases/shared/storage_setup.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

constexpr Duration period = milliseconds{20};

/// Sets the overflow value of the SYNC counter, if the EDS has 1019h; 0: no counter. 1006h must be 0.
void set_overflow(Dut& dut, std::uint8_t overflow) {
  if (dut.has(sync_overflow) && dut.read_number(sync_overflow) != overflow) dut.write(sync_overflow, 0, overflow);
}

/// Returns the CAN-ID of SYNC. Not applicable if the device cannot produce it.
std::uint32_t need_producer(Dut& dut) {
  const std::uint32_t cob_id = stop_sync(dut);
  dut.need_writable(sync_period);
  if (!can_produce_sync(dut, cob_id))
    dut.not_applicable("the device does not produce SYNC: bit 30 of 1005h:00 cannot be 1");
  return cob_id;
}

void default_cob_id(Dut& dut) { expect_default_cob_id(dut, sync_cob_id, 0x80); }

/// Fails if a SYNC is received.
void expect_silence(Dut& dut, std::uint32_t cob_id, const std::string& when) {
  const auto seen = dut.collect(Dut::with_cob_id(cob_id), period * 10);
  dut.expect(seen.empty(), "no SYNC " + when, fmt::format("{} within {} ms", seen.size(), period.count() / 100));
}

std::vector<SeenFrame> syncs_since(Dut& dut, Dut::Mark since, std::uint32_t cob_id, Duration span) {
  dut.pass_time(span);
  return dut.received_since(since, Dut::with_cob_id(cob_id));
}

void count_messages(Dut& dut) {
  const std::uint32_t cob_id = need_producer(dut);
  set_overflow(dut, 0);
  const Dut::Mark since = dut.mark();
  const std::uint64_t began = dut.now();
  start_sync(dut, cob_id, period);
  const std::uint64_t written = dut.now();
  const std::vector<SeenFrame> seen = syncs_since(dut, since, cob_id, period * 50);
  dut.expect(seen.size() >= 2, "SYNCs every 20 ms", fmt::format("{} in a second", seen.size()));
  dut.expect_time(seen.front().at - began, 0, written - began + period.count(),
                  "the first SYNC after 1006h:00 is written");
  for (const SeenFrame& sync : seen) dut.expect_equal(sync.frame.size, 0, "bytes of a SYNC without counter");
  dut.expect_times(intervals_of(seen), period.count() * 9 / 10, period.count() * 11 / 10, "the time between two SYNCs");
  const std::uint64_t mean = (seen.back().at - seen.front().at) / (seen.size() - 1);
  dut.expect_time(mean, period.count() * 49 / 50, period.count() * 51 / 50, "the mean time between SYNCs");
  dut.write(sync_period, 0, 0);
  expect_silence(dut, cob_id, "after 1006h:00 is 0");
}

void count_tpdos(Dut& dut) {
  const std::uint32_t cob_id = stop_sync(dut);
  set_overflow(dut, 0);
  constexpr std::uint8_t every = 2;
  const std::optional<std::uint32_t> tpdo = set_up_tpdo(dut, every, 0);
  if (!tpdo) dut.not_applicable("the device has no TPDO of transmission type 2");
  dut.enter(NmtState::operational);
  dut.pass_time(milliseconds{100});
  std::size_t sent = 0;
  for (unsigned sync = 1; sync <= 8; ++sync) {
    const Dut::Mark since = dut.mark();
    dut.send(canopen::CobId{cob_id}.can_id(), {});
    dut.pass_time(period);
    const std::size_t now = dut.received_since(since, Dut::with_cob_id(*tpdo)).size();
    dut.expect(now <= 1, "at most one TPDO after a SYNC", std::to_string(now));
    sent += now;
    const std::size_t expected = sync / every;
    dut.expect(sent == expected || sent == (sync + 1) / every, fmt::format("{} TPDOs after {} SYNCs", expected, sync),
               std::to_string(sent));
  }
  dut.expect_equal(sent, 4, "TPDOs of type 2 after eight SYNCs");
}

void no_producer(Dut& dut) {
  const std::uint32_t cob_id = stop_sync(dut);
  dut.need_writable(sync_period);
  dut.pass_time(milliseconds{50});
  const auto expect_none = [&dut, cob_id](Dut::Mark since, const std::string& when) {
    const std::size_t seen = syncs_since(dut, since, cob_id, period * 10).size();
    dut.expect(seen == 0, "no SYNC " + when, std::to_string(seen));
  };
  const Dut::Mark consumes = dut.mark();
  dut.write(sync_period, 0, period.count());
  expect_none(consumes, "while bit 30 of 1005h:00 is 0");
  dut.write(sync_period, 0, 0);
  const Dut::Mark without_period = dut.mark();
  if (!can_produce_sync(dut, cob_id)) return;
  dut.write(sync_cob_id, 0, cob_id | canopen::CobId::no_rtr_bit);
  dut.expect_equal(dut.read_number(sync_cob_id), cob_id | canopen::CobId::no_rtr_bit, "1005h:00");
  expect_none(without_period, "while 1006h:00 is 0");
}

void invalid_overflow(Dut& dut) {
  dut.need_writable(sync_overflow);
  stop_sync(dut);
  const std::uint64_t before = dut.read_number(sync_overflow);
  for (const std::uint64_t reserved : {1U, 241U, 255U}) {
    expect_refused(dut, sync_overflow, 0, reserved, before, abort_rule::value, fmt::format("{} to 1019h:00", reserved));
  }
}

/// Starts the SYNC producer and expects SYNCs with one byte that counts from 1.
void expect_counting(Dut& dut, std::uint32_t cob_id, std::uint8_t overflow) {
  const Dut::Mark since = dut.mark();
  start_sync(dut, cob_id, period);
  const std::vector<SeenFrame> seen = syncs_since(dut, since, cob_id, period * (overflow * 3U + 1U));
  dut.expect(seen.size() >= overflow * 2U, fmt::format("at least {} SYNCs", overflow * 2), std::to_string(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    dut.expect_equal(seen[i].frame.size, 1, "bytes of a SYNC with counter");
    dut.expect_equal(seen[i].frame.data[0], i % overflow + 1, fmt::format("the counter of SYNC {}", i + 1));
  }
}

void no_overflow(Dut& dut) {
  dut.need_writable(sync_overflow);
  const std::uint32_t cob_id = stop_sync(dut);
  dut.write(sync_overflow, 0, 10);
  dut.expect_equal(dut.read_number(sync_overflow), 10, "1019h:00");
  dut.write(sync_overflow, 0, 0);
  dut.expect_equal(dut.read_number(sync_overflow), 0, "1019h:00");
  if (!dut.allowed(Permission::outputs) || !can_produce_sync(dut, cob_id)) return;
  const Dut::Mark since = dut.mark();
  start_sync(dut, cob_id, period);
  const std::vector<SeenFrame> seen = syncs_since(dut, since, cob_id, period * 5);
  dut.expect(!seen.empty(), "SYNCs", "none");
  for (const SeenFrame& sync : seen) dut.expect_equal(sync.frame.size, 0, "bytes of a SYNC without counter");
}

void counter(Dut& dut) {
  dut.need_writable(sync_overflow);
  const std::uint32_t cob_id = need_producer(dut);
  constexpr std::uint8_t overflow = 3;
  set_overflow(dut, overflow);
  dut.enter(NmtState::pre_operational);
  expect_counting(dut, cob_id, overflow);
  dut.enter(NmtState::stopped);
  expect_silence(dut, cob_id, "in Stopped");
  const Dut::Mark since = dut.mark();
  dut.nmt(NmtCommand::enter_pre_operational);
  const auto first = dut.wait_for(Dut::with_cob_id(cob_id), period * 5, since);
  dut.expect(first.has_value(), "SYNCs after Stopped", "none");
  dut.expect_equal(first->frame.data[0], 1, "the counter of the first SYNC after Stopped");
}

void stored_counter(Dut& dut) {
  dut.need_writable(sync_overflow);
  with_storage(dut, save_communication(dut), [&dut](const Storage& storage) {
    stop_sync(dut);
    const std::uint8_t overflow = dut.read_number(sync_overflow) == 5 ? 4 : 5;
    dut.write(sync_overflow, 0, overflow);
    storage.save();
    dut.reset(NmtCommand::reset_node);
    dut.expect_equal(dut.read_number(sync_overflow), overflow, "1019h:00 as stored");
    if (!dut.allowed(Permission::outputs)) return;
    const std::uint32_t cob_id = stop_sync(dut);
    if (!can_produce_sync(dut, cob_id)) return;
    expect_counting(dut, cob_id, overflow);
  });
}

void overflow_in_use(Dut& dut) {
  dut.need_writable(sync_overflow);
  dut.need_writable(sync_period);
  stop_sync(dut);
  const std::uint64_t before = dut.read_number(sync_overflow);
  dut.write(sync_period, 0, 100'000);
  expect_refused(dut, sync_overflow, 0, before == 10 ? 20 : 10, before, abort_rule::state,
                 "another value to 1019h:00 while 1006h:00 is not 0");
}

void stored_values(Dut& dut) {
  dut.need_writable(sync_cob_id);
  with_storage(dut, save_communication(dut), [&dut](const Storage& storage) {
    const std::uint32_t cob_id = stop_sync(dut);
    const auto set = [&dut](std::uint16_t index, std::uint64_t value) {
      if (!dut.is_writable(index)) return;
      if (is_within_limits(dut, *dut.entry(index, 0), dut.bytes_of(index, 0, value))) dut.write(index, 0, value);
    };
    set(sync_overflow, 7);
    set(sync_cob_id, cob_id == 0x6A0 ? 0x6A1 : 0x6A0);  // not used in the pre-defined connection set
    set(sync_period, 40'000);
    set(sync_window, 10'000);
    std::vector<std::pair<std::uint16_t, std::uint64_t>> stored;
    for (const std::uint16_t index : {sync_cob_id, sync_period, sync_window, sync_overflow}) {
      if (dut.has(index)) stored.emplace_back(index, dut.read_number(index));
    }
    storage.save();
    dut.reset(NmtCommand::reset_node);
    for (const auto& [index, value] : stored) {
      dut.expect_equal(dut.read_number(index), value, label(index, 0) + " as stored");
    }
  });
}

// ---- TIME, and COB-IDs that do not change while their service is active ----

constexpr std::uint16_t time_cob_id = 0x1012;

void default_time_cob_id(Dut& dut) { expect_default_cob_id(dut, time_cob_id, 0x100); }

/// Bits 0 to 29 do not change while one of these bits is 1. Not applicable if the device does not accept the bits.
void expect_fixed(Dut& dut, std::uint16_t index, std::uint32_t active_bits) {
  dut.need_writable(index);
  const auto present = static_cast<std::uint32_t>(dut.read_number(index));
  const std::uint32_t can_id = present & canopen::CobId::identifier;
  const std::uint32_t active = can_id | active_bits;
  const SdoOutcome outcome = dut.download(index, 0, active);
  if (!outcome.done()) {
    dut.expect_abort(outcome, abort_rule::value, fmt::format("{:08X}h to {}", active, label(index, 0)));
    dut.not_applicable(fmt::format("{} does not accept {:08X}h", label(index, 0), active));
  }
  constexpr AbortRule in_use{
      {canopen::AbortCode::invalid_value, canopen::AbortCode::device_state, canopen::AbortCode::unsupported_access},
      {canopen::AbortCode::parameter_incompatible, canopen::AbortCode::read_only, canopen::AbortCode::general}};
  const std::uint32_t other = can_id == 0x6A0 ? 0x6A1 : 0x6A0;  // not in the pre-defined connection set
  expect_refused(dut, index, 0, other | active_bits, active, in_use,
                 fmt::format("another CAN-ID to {} while its service is active", label(index, 0)));
}

/// While the device consumes and produces TIME. The application starts the producer.
void time_cob_id_fixed(Dut& dut) {
  constexpr std::uint32_t consumes_and_produces = 0xC000'0000;
  dut.need(time_cob_id);
  expect_fixed(dut, time_cob_id, consumes_and_produces);
}

/// While the device produces SYNC, here without a period.
void sync_cob_id_fixed(Dut& dut) {
  const std::uint32_t cob_id = stop_sync(dut);
  dut.need_writable(sync_period);
  if (!can_produce_sync(dut, cob_id))
    dut.not_applicable("the device does not produce SYNC: bit 30 of 1005h:00 cannot be 1");
  expect_fixed(dut, sync_cob_id, canopen::CobId::no_rtr_bit);
}

constexpr CaseRow sync_rows[] = {
    {"6.1", "1005h holds the default COB-ID of SYNC", "CiA 301, 7.5.2.5", Level::communication, Permission::none,
     default_cob_id},
    {"6.2", "A SYNC producer sends a SYNC in each period of 1006h", "CiA 301, 7.2.5.3 and 7.5.2.6",
     Level::communication, Permission::outputs, count_messages, Condition::punctual},
    {"6.3", "A TPDO of type 2 is sent at every second SYNC", "CiA 301, 7.2.5 and 7.5.2.37", Level::communication,
     Permission::outputs, count_tpdos, Condition::state | Condition::punctual},
    {"6.4", "A SYNC consumer, and a producer without a period, send no SYNC", "CiA 301, 7.5.2.5 and 7.5.2.6",
     Level::communication, Permission::none, no_producer},
    {"6.5", "1019h refuses the reserved values 1, 241 and 255", "CiA 301, 7.5.2.22", Level::communication,
     Permission::none, invalid_overflow},
    {"6.6", "With 1019h = 0 a SYNC has no counter", "CiA 301, 7.5.2.22", Level::communication, Permission::none,
     no_overflow},
    {"6.7", "The SYNC counter counts from 1 to 1019h and restarts with 1 after Stopped",
     "CiA 301, 7.2.5.1 and 7.5.2.22", Level::communication, Permission::outputs, counter,
     Condition::state | Condition::punctual, "6.2"},
    {"6.8", "1019h has its stored value after a reset", "CiA 301, 7.5.2.13 and 7.5.2.22", Level::communication,
     Permission::store, stored_counter, Condition::none, "8.2"},
    {"6.9", "1019h refuses a new value while 1006h is not 0", "CiA 301, 7.5.2.22", Level::communication,
     Permission::none, overflow_in_use},
    {"6.10", "The SYNC parameters have their stored values after a reset", "CiA 301, 7.5.2.13", Level::communication,
     Permission::store, stored_values, Condition::none, "8.2"},
    {"6.101", "1012h holds the default COB-ID of TIME", "CiA 301, 7.5.2.15", Level::communication, Permission::none,
     default_time_cob_id},
    {"6.102", "The CAN-ID of TIME does not change while the device consumes and produces TIME", "CiA 301, 7.5.2.15",
     Level::communication, Permission::none, time_cob_id_fixed},
    {"6.103", "The CAN-ID of SYNC does not change while the device produces SYNC", "CiA 301, 7.5.2.5",
     Level::communication, Permission::none, sync_cob_id_fixed},
};

}  // namespace

std::span<const CaseRow> sync_cases() { return sync_rows; }

}  // namespace edsc::conform
