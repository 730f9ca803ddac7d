#include "conform/cases/nmt/error_control.hpp"

#include <fmt/format.h>

#include <canopen/emcy/error_register.hpp>

namespace edsc::conform {

void need_guarding(Dut& dut) {
  dut.need(guard_time);
  dut.need(life_time_factor);
  if (!dut.has(producer_heartbeat)) return;
  if (dut.read_number(producer_heartbeat) != 0) {
    dut.need_writable(producer_heartbeat);
    dut.write(producer_heartbeat, 0, 0);
  }
}

void configure_guarding(Dut& dut) {
  need_guarding(dut);
  if (!dut.is_writable(guard_time) || !dut.is_writable(life_time_factor)) return;
  dut.write(guard_time, 0, 2000);
  dut.write(life_time_factor, 0, 10);
}

std::vector<SeenFrame> answers(Dut& dut) {
  const Dut::Mark since = dut.mark();
  dut.send_remote(0x700U + dut.node().value(), 1);
  dut.pass_time(to_answer_guarding);
  return dut.received_since(since, dut.error_control());
}

std::uint8_t guard(Dut& dut) {
  const Dut::Mark since = dut.mark();
  std::vector<SeenFrame> seen = answers(dut);
  if (seen.empty() && dut.wait_for(dut.error_control(), to_answer_guarding_late, since)) {
    dut.pass_time(to_answer_guarding);
    seen = dut.received_since(since, dut.error_control());
  }
  dut.expect(seen.size() == 1, "one answer to a remote frame of node guarding",
             seen.empty() ? "none" : std::to_string(seen.size()));
  dut.note_remote_frame_answered();
  dut.expect_equal(seen[0].frame.size, 1, "bytes of the answer");
  return seen[0].frame.data[0];
}

void expect_guarded(Dut& dut, NmtState state, bool toggle) {
  const std::uint8_t byte = guard(dut);
  dut.expect_equal(byte & 0x7FU, static_cast<unsigned>(state), "the NMT state in the answer");
  dut.expect_equal((byte & toggle_bit) != 0 ? 1 : 0, toggle ? 1 : 0, "the toggle bit of the answer");
}

Dut::Match error_control_event(Dut& dut) {
  if (!dut.has(emcy)) dut.inconclusive("1014h:00 does not exist in the EDS: the device cannot report the event");
  return emcy_with_code(emcy_cob_id(dut), canopen::emergency_code::error_control);
}

void expect_not_lost(Dut& dut, const Dut::Match& event, Dut::Mark since, const std::string& when) {
  dut.expect(dut.received_since(since, event).empty(), "no EMCY with code 8130h " + when, "one");
}

void start_heartbeat(Dut& dut) {
  dut.need_writable(producer_heartbeat);
  dut.enter(NmtState::pre_operational);
  dut.write(producer_heartbeat, 0, beat.count() / 1000);
  dut.pass_time(beat / 2);
}

void expect_heartbeats(Dut& dut, NmtState state, Duration period, unsigned count) {
  const std::vector<SeenFrame> seen = dut.collect(dut.error_control(), period * count + period / 2);
  const std::string wanted = fmt::format("{} heartbeats in {} ms", count, period.count() * count / 1000);
  dut.expect(seen.size() + 1 >= count && seen.size() <= count + 1, wanted, std::to_string(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    dut.expect_equal(seen[i].frame.size, 1, "bytes of a heartbeat");
    dut.expect_equal(seen[i].frame.data[0], static_cast<unsigned>(state), "the byte of a heartbeat");
  }
  dut.expect_times(intervals_of(seen), period.count() * 9 / 10, period.count() * 11 / 10,
                   "the time between two heartbeats");
}

void expect_no_heartbeats(Dut& dut) {
  const auto seen = dut.collect(dut.error_control(), beat * 10);
  dut.expect(seen.empty(), "no heartbeat while 1017h:00 is 0", fmt::format("{} in a second", seen.size()));
}

}  // namespace edsc::conform
