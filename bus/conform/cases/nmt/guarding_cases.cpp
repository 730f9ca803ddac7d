/// Node and life guarding (CiA 301, 7.2.8.3.2.1).
#include <fmt/format.h>

#include <utility>

#include "conform/case.hpp"
#include "conform/cases/nmt/error_control.hpp"

namespace edsc::conform {
namespace {

/// Sends guarding requests for all other node-IDs and returns the error control messages of other node-IDs.
std::vector<SeenFrame> foreign_answers(Dut& dut) {
  const Dut::Mark since = dut.mark();
  for (std::uint32_t node = 1; node <= 127; ++node) {
    if (node == dut.node().value()) continue;
    dut.send_remote(0x700U + node, 1);
    dut.pass_time(milliseconds{2});
  }
  dut.pass_time(to_answer_guarding);
  return dut.received_since(since, [own = dut.node().value()](const canopen::Frame& frame) {
    return (frame.id & 0x780U) == 0x700U && (frame.id & 0x7FU) != own && !frame.extended && !frame.remote;
  });
}

void read_guarding(Dut& dut) {
  dut.need(guard_time);
  dut.expect_equal(dut.read(guard_time).size(), 2, "bytes of 100Ch:00");
  dut.expect(dut.has(life_time_factor), "100Dh, which belongs to 100Ch", "it does not exist in the EDS");
  dut.expect_equal(dut.read(life_time_factor).size(), 1, "bytes of 100Dh:00");
}

void answer(Dut& dut) {
  need_guarding(dut);
  dut.enter(NmtState::pre_operational);
  dut.expect_equal(guard(dut) & 0x7FU, static_cast<unsigned>(NmtState::pre_operational), "the NMT state in the answer");
}

void toggle(Dut& dut) {
  need_guarding(dut);
  for (int round = 0; round < 2; ++round) {
    dut.reset(NmtCommand::reset_communication);
    configure_guarding(dut);
    dut.enter(NmtState::pre_operational);
    // An odd number, so that the next response would have the bit 1 without the reset.
    for (const bool bit : {false, true, false}) expect_guarded(dut, NmtState::pre_operational, bit);
  }
}

void foreign_requests(Dut& dut) {
  configure_guarding(dut);
  if (hears_other_nodes(dut, milliseconds{1200})) {
    dut.inconclusive(Condition::alone,
                     "other nodes are on the bus and must not be guarded; test the device alone on the bus");
  }
  dut.enter(NmtState::pre_operational);
  (void)guard(dut);
  if (foreign_answers(dut).empty()) return (void)guard(dut);
  dut.enter(NmtState::stopped);  // another node does not follow
  for (const SeenFrame& seen : foreign_answers(dut)) {
    const bool follows = (seen.frame.data[0] & 0x7FU) == static_cast<unsigned>(NmtState::stopped);
    dut.expect(!follows, "no answer to a request for another node-ID", fmt::format("one on {:X}h", seen.frame.id));
  }
  dut.inconclusive(Condition::alone, "another node is on the bus; test the device alone on the bus");
}

void write_guarding(Dut& dut) {
  dut.need_writable(guard_time);
  dut.need_writable(life_time_factor);
  for (const auto& [time, factor] : {std::pair{500, 3}, std::pair{1000, 2}, std::pair{0, 0}}) {
    dut.write(guard_time, 0, static_cast<std::uint64_t>(time));
    dut.write(life_time_factor, 0, static_cast<std::uint64_t>(factor));
    dut.expect_equal(dut.read_number(guard_time), static_cast<std::uint64_t>(time), "100Ch:00");
    dut.expect_equal(dut.read_number(life_time_factor), static_cast<std::uint64_t>(factor), "100Dh:00");
  }
}

constexpr Duration tested_time = milliseconds{100};
constexpr std::uint8_t tested_factor = 3;
constexpr Duration life_time = tested_time * tested_factor;

/// Configures a node life time of 300 ms, in Pre-operational. Returns the match for its event.
Dut::Match start_life_guarding(Dut& dut) {
  need_guarding(dut);
  dut.need_writable(guard_time);
  dut.need_writable(life_time_factor);
  Dut::Match event = error_control_event(dut);
  dut.enter(NmtState::pre_operational);
  dut.write(guard_time, 0, tested_time.count() / 1000);
  dut.write(life_time_factor, 0, tested_factor);
  return event;
}

void life_guarding(Dut& dut) {
  const Dut::Match event = start_life_guarding(dut);
  const Dut::Mark began = dut.mark();
  std::uint64_t last = 0;
  for (unsigned i = 0; i < 8; ++i) {
    last = dut.now();
    (void)guard(dut);
    dut.pass_time(tested_time - to_answer_guarding);
  }
  dut.expect(dut.received_since(began, event).empty(), "no EMCY with code 8130h while requests are sent", "one");
  const auto lost = dut.wait_for(event, life_time * 2, began);
  dut.expect(lost.has_value(), "an EMCY with code 8130h after the life time of 300 ms", "none");
  dut.expect_time(lost->at - last, life_time.count(), (life_time + tested_time).count(),
                  "the EMCY after the last request");
  const std::uint8_t byte = guard(dut);
  dut.expect_equal(byte & 0x7FU, static_cast<unsigned>(NmtState::pre_operational), "the NMT state after the event");
}

void life_guarding_begins(Dut& dut) {
  const Dut::Match event = start_life_guarding(dut);
  const Dut::Mark began = dut.mark();
  dut.pass_time(life_time * 2);
  expect_not_lost(dut, event, began, "before the first request");
}

constexpr CaseRow guarding_rows[] = {
    {"7.1", "100Ch and 100Dh can be read", "CiA 301, 7.5.2.11 and 7.5.2.12", Level::communication, Permission::none,
     read_guarding},
    {"7.2", "A remote frame of node guarding is answered once, with the NMT state", "CiA 301, 7.2.8.3.2.1",
     Level::communication, Permission::none, answer, Condition::remote_frames},
    {"7.3", "The toggle bit is 0 after a reset and alternates", "CiA 301, 7.2.8.3.2.1", Level::communication,
     Permission::none, toggle, Condition::remote_frames, "7.2"},
    {"7.4", "Remote frames of node guarding for other node-IDs are not answered", "CiA 301, 7.2.8.3.2.1 and 7.3.5",
     Level::communication, Permission::none, foreign_requests, Condition::remote_frames | Condition::alone, "7.2"},
    {"7.5", "100Ch and 100Dh keep the written values", "CiA 301, 7.5.2.11 and 7.5.2.12", Level::communication,
     Permission::none, write_guarding},
    {"7.6", "After a node life time without guarding requests the device sends an EMCY with code 8130h",
     "CiA 301, 7.2.8.3.2.1", Level::communication, Permission::none, life_guarding,
     Condition::remote_frames | Condition::punctual, "7.2"},
    {"7.7", "Life guarding begins with the first guarding request", "CiA 301, 7.2.8.3.2.1", Level::communication,
     Permission::none, life_guarding_begins},
};

}  // namespace

std::span<const CaseRow> guarding_cases() { return guarding_rows; }

}  // namespace edsc::conform
