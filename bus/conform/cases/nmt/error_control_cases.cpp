/// Area 7: error control (CiA 301, 7.2.8.3.2), and which of guarding and heartbeat is active.
#include <fmt/format.h>

#include "conform/case.hpp"
#include "conform/cases/nmt/error_control.hpp"

namespace edsc::conform {
namespace {

void need_both(Dut& dut) {
  dut.need_writable(guard_time);
  dut.need_writable(life_time_factor);
  dut.need_writable(producer_heartbeat);
}

/// Writes 100Ch and 100Dh: 0 disables life guarding.
void set_guarding(Dut& dut, std::uint16_t milliseconds_between, std::uint8_t factor) {
  dut.write(guard_time, 0, milliseconds_between);
  dut.write(life_time_factor, 0, factor);
}

void one_of_both(Dut& dut) {
  const bool guarding = dut.has(guard_time) && dut.has(life_time_factor);
  if (!guarding && !dut.has(producer_heartbeat)) {
    dut.fail_by_sheet("error-control", "1017h, or 100Ch and 100Dh", "the EDS has neither");
  }
  for (const std::uint16_t index : {guard_time, life_time_factor, producer_heartbeat}) {
    if (dut.has(index)) (void)dut.read_number(index);
  }
}

void heartbeat_off(Dut& dut) {
  need_both(dut);
  start_heartbeat(dut);
  dut.write(producer_heartbeat, 0, 0);
  dut.expect_equal(dut.read_number(producer_heartbeat), 0, "1017h:00");
  expect_no_heartbeats(dut);
}

void guarding_without_heartbeat(Dut& dut) {
  need_both(dut);
  start_heartbeat(dut);
  configure_guarding(dut);
  dut.pass_time(beat);
  const bool first = (guard(dut) & toggle_bit) != 0;
  for (const bool bit : {!first, first, !first}) expect_guarded(dut, NmtState::pre_operational, bit);
}

void heartbeat_without_guarding(Dut& dut) {
  need_both(dut);
  set_guarding(dut, 0, 0);
  start_heartbeat(dut);
  expect_heartbeats(dut, NmtState::pre_operational, beat, 10);
}

/// Sends remote frames between heartbeats. Expects no answer to them, and no missing heartbeat.
void expect_requests_ignored(Dut& dut) {
  const auto first = dut.wait_for(dut.heartbeat(), beat * 3);
  dut.expect(first.has_value(), "a heartbeat every 100 ms", "none");
  for (unsigned i = 0; i < 5; ++i) {
    dut.pass_time(beat / 4);
    const auto answered = answers(dut);
    dut.expect(answered.empty(), "no answer to a remote frame of node guarding while 1017h:00 is not 0",
               std::to_string(answered.size()));
    const auto seen = dut.wait_for(dut.error_control(), beat * 2);
    dut.expect(seen.has_value(), "a heartbeat every 100 ms", "none");
    dut.expect_equal(seen->frame.data[0], static_cast<unsigned>(NmtState::pre_operational), "the byte of a heartbeat");
  }
}

void requests_without_guarding(Dut& dut) {
  need_both(dut);
  set_guarding(dut, 0, 0);
  start_heartbeat(dut);
  expect_requests_ignored(dut);
}

void heartbeat_with_guarding(Dut& dut) {
  need_both(dut);
  set_guarding(dut, 100, 2);
  start_heartbeat(dut);
  const Dut::Mark since = dut.mark();
  expect_heartbeats(dut, NmtState::pre_operational, beat, 10);
  if (dut.has(emcy)) expect_not_lost(dut, error_control_event(dut), since, "while 1017h:00 is not 0");
}

void requests_with_guarding(Dut& dut) {
  need_both(dut);
  set_guarding(dut, 100, 2);
  start_heartbeat(dut);
  const Dut::Mark since = dut.mark();
  expect_requests_ignored(dut);
  dut.pass_time(beat * 5);
  if (dut.has(emcy)) expect_not_lost(dut, error_control_event(dut), since, "while 1017h:00 is not 0");
}

constexpr CaseRow error_control_rows[] = {
    {"7.201", "The device has heartbeat or node guarding", "CiA 301, 7.2.8.3.2", Level::communication, Permission::none,
     one_of_both},
    {"7.202", "A device with heartbeat and node guarding stops its heartbeat if 1017h = 0", "CiA 301, 7.5.2.20",
     Level::communication, Permission::none, heartbeat_off, Condition::punctual, "7.102"},
    {"7.203", "Without heartbeat the device answers node guarding", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, guarding_without_heartbeat, Condition::remote_frames, "7.2"},
    {"7.204", "With 100Ch and 100Dh = 0 the device sends heartbeats", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, heartbeat_without_guarding, Condition::punctual, "7.102"},
    {"7.205", "While heartbeat is active a remote frame is not answered", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, requests_without_guarding, Condition::remote_frames | Condition::punctual, "7.102"},
    {"7.206", "With 100Ch and 100Dh set the device sends heartbeats, without a life guarding event",
     "CiA 301, 7.2.8.3.2", Level::communication, Permission::none, heartbeat_with_guarding, Condition::punctual,
     "7.102"},
    {"7.207", "With 100Ch and 100Dh set a remote frame is not answered while heartbeat is active", "CiA 301, 7.2.8.3.2",
     Level::communication, Permission::none, requests_with_guarding, Condition::remote_frames | Condition::punctual,
     "7.102"},
};

}  // namespace

std::span<const CaseRow> error_control_cases() { return error_control_rows; }

}  // namespace edsc::conform
