/// Error control (CiA 301, 7.2.8.3.2): node and life guarding, heartbeat, and which of the two is active.
#include <fmt/format.h>

#include <canopen/emcy/error_register.hpp>
#include <canopen/nmt/error_control.hpp>

#include "conform/cases/setup.hpp"

namespace edsc::conform {
namespace error_control_area {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;
using canopen::NodeId;

constexpr std::uint16_t guard_time = 0x100C, life_time_factor = 0x100D;
constexpr std::uint16_t consumer_time = 0x1016, producer_time = 0x1017;
constexpr std::uint8_t toggle_bit = 0x80;

/// The time that a device may need to answer a guarding request.
constexpr Duration to_answer = milliseconds{50};

// ---- node and life guarding ----

/// Not applicable if the EDS does not have node guarding. Disables heartbeat, which excludes guarding.
void need_guarding(Dut& dut) {
  dut.need(guard_time);
  dut.need(life_time_factor);
  if (!dut.has(producer_time)) return;
  if (dut.read_number(producer_time) != 0) {
    dut.need_writable(producer_time);
    dut.write(producer_time, 0, 0);
  }
}

/// Sends one guarding request and returns all error control messages that answer it.
std::vector<SeenFrame> answers(Dut& dut) {
  const Dut::Mark since = dut.mark();
  dut.send_remote(0x700U + dut.node().value(), 1);
  dut.pass_time(to_answer);
  return dut.received_since(since, dut.error_control());
}

/// Sends one guarding request, expects one message of one byte, and returns the byte.
std::uint8_t guard(Dut& dut) {
  const std::vector<SeenFrame> seen = answers(dut);
  dut.expect(seen.size() == 1, "one answer to a remote frame of node guarding",
             seen.empty() ? "none, or the bus does not carry remote frames" : std::to_string(seen.size()));
  dut.expect_equal(seen[0].frame.size, 1, "bytes of the answer");
  return seen[0].frame.data[0];
}

void expect_guarded(Dut& dut, NmtState state, bool toggle) {
  const std::uint8_t byte = guard(dut);
  dut.expect_equal(byte & 0x7FU, static_cast<unsigned>(state), "the NMT state in the answer");
  dut.expect_equal((byte & toggle_bit) != 0 ? 1 : 0, toggle ? 1 : 0, "the toggle bit of the answer");
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
    need_guarding(dut);
    dut.enter(NmtState::pre_operational);
    for (const bool bit : {false, true, false, true}) expect_guarded(dut, NmtState::pre_operational, bit);
  }
}

/// Sends guarding requests for all other node-IDs and returns the error control messages of other node-IDs.
std::vector<SeenFrame> foreign_answers(Dut& dut) {
  const Dut::Mark since = dut.mark();
  for (std::uint32_t node = 1; node <= 127; ++node) {
    if (node == dut.node().value()) continue;
    dut.send_remote(0x700U + node, 1);
    dut.pass_time(milliseconds{2});
  }
  dut.pass_time(to_answer);
  return dut.received_since(since, [own = dut.node().value()](const canopen::Frame& frame) {
    return (frame.id & 0x780U) == 0x700U && (frame.id & 0x7FU) != own && !frame.extended && !frame.remote;
  });
}

void foreign_requests(Dut& dut) {
  need_guarding(dut);
  if (hears_other_nodes(dut, milliseconds{1200})) {
    dut.inconclusive("other nodes are on the bus and must not be guarded; test the device alone on the bus");
  }
  dut.enter(NmtState::pre_operational);
  (void)guard(dut);
  if (foreign_answers(dut).empty()) return (void)guard(dut);
  dut.enter(NmtState::stopped);  // another node does not follow
  for (const SeenFrame& seen : foreign_answers(dut)) {
    const bool follows = (seen.frame.data[0] & 0x7FU) == static_cast<unsigned>(NmtState::stopped);
    dut.expect(!follows, "no answer to a request for another node-ID", fmt::format("one on {:X}h", seen.frame.id));
  }
  dut.inconclusive("another node is on the bus; test the device alone on the bus");
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

/// The EMCY with which the device reports a lost node. Inconclusive if the EDS does not have 1014h.
Dut::Match error_control_event(Dut& dut) {
  if (!dut.has(0x1014)) dut.inconclusive("1014h:00 does not exist in the EDS: the device cannot report the event");
  return emcy_with_code(emcy_cob_id(dut), canopen::emergency_code::error_control);
}

void life_guarding(Dut& dut) {
  need_guarding(dut);
  dut.need_writable(guard_time);
  dut.need_writable(life_time_factor);
  const Dut::Match event = error_control_event(dut);
  constexpr Duration time = milliseconds{100};
  constexpr std::uint8_t factor = 3;
  dut.enter(NmtState::pre_operational);
  dut.write(guard_time, 0, time.count() / 1000);
  dut.write(life_time_factor, 0, factor);
  const Dut::Mark began = dut.mark();
  dut.pass_time(time * (factor + 2));  // life guarding begins with the first request
  std::uint64_t last = 0;
  for (unsigned i = 0; i < 8; ++i) {
    last = dut.now();
    (void)guard(dut);
    dut.pass_time(time - to_answer);
  }
  dut.expect(dut.received_since(began, event).empty(), "no EMCY with code 8130h while requests are sent", "one");
  const auto lost = dut.wait_for(event, time * factor * 2, began);
  dut.expect(lost.has_value(), "an EMCY with code 8130h after the life time of 300 ms", "none");
  dut.expect_time(lost->at - last, std::uint64_t{time.count()} * factor, std::uint64_t{time.count()} * (factor + 1),
                  "the EMCY after the last request");
  const std::uint8_t byte = guard(dut);
  dut.expect_equal(byte & 0x7FU, static_cast<unsigned>(NmtState::pre_operational), "the NMT state after the event");
}

// ---- heartbeat producer ----

constexpr Duration beat = milliseconds{100};

/// Expects a heartbeat with this state in each period, and no other frame with its CAN-ID.
void expect_heartbeats(Dut& dut, NmtState state, Duration period, unsigned count) {
  const std::vector<SeenFrame> seen = dut.collect(dut.error_control(), period * count + period / 2);
  const std::string wanted = fmt::format("{} heartbeats in {} ms", count, period.count() * count / 1000);
  dut.expect(seen.size() + 1 >= count && seen.size() <= count + 1, wanted, std::to_string(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    dut.expect_equal(seen[i].frame.size, 1, "bytes of a heartbeat");
    dut.expect_equal(seen[i].frame.data[0], static_cast<unsigned>(state), "the byte of a heartbeat");
    if (i == 0) continue;
    dut.expect_time(seen[i].at - seen[i - 1].at, period.count() * 9 / 10, period.count() * 11 / 10,
                    "the time between two heartbeats");
  }
}

void expect_no_heartbeats(Dut& dut) {
  const auto seen = dut.collect(dut.error_control(), beat * 10);
  dut.expect(seen.empty(), "no heartbeat while 1017h:00 is 0", fmt::format("{} in a second", seen.size()));
}

void start_heartbeat(Dut& dut) {
  dut.need_writable(producer_time);
  dut.enter(NmtState::pre_operational);
  dut.write(producer_time, 0, beat.count() / 1000);
  dut.pass_time(beat / 2);
}

void write_heartbeat(Dut& dut) {
  dut.need_writable(producer_time);
  for (const std::uint64_t time : {500U, 1000U, 0U}) {
    dut.write(producer_time, 0, time);
    const Bytes read = dut.read(producer_time);
    dut.expect_equal(read.size(), 2, "bytes of 1017h:00");
    dut.expect_equal(number_of(read), time, "1017h:00");
  }
}

void count_heartbeats(Dut& dut) {
  start_heartbeat(dut);
  expect_heartbeats(dut, NmtState::pre_operational, beat, 20);
}

void stop_heartbeat(Dut& dut) {
  start_heartbeat(dut);
  dut.expect(!dut.collect(dut.heartbeat(), beat * 3).empty(), "a heartbeat every 100 ms", "none");
  dut.write(producer_time, 0, 0);
  expect_no_heartbeats(dut);
}

// ---- heartbeat consumer ----

/// A heartbeat producer that the test simulates, and the entry of 1016h that monitors it.
class Producer {
 public:
  explicit Producer(Dut& dut) : dut_{dut} {
    const std::optional<Value>& limit = dut.need_writable(consumer_time, 1).high_limit;
    node_ = free_node_id(dut);
    if (limit && limit->bits < value(milliseconds{0xFFFF})) {
      dut.not_applicable(fmt::format("the EDS limits 1016h:01 to {:X}h, which is too low for a node-ID", limit->bits));
    }
  }

  void watch(Duration time, std::uint8_t sub_index = 1) const { dut_.write(consumer_time, sub_index, value(time)); }

  [[nodiscard]] std::uint64_t value(Duration time) const {
    return std::uint64_t{node_.value()} << 16 | time.count() / 1000;
  }

  /// Sends one heartbeat and returns the time.
  std::uint64_t beat(NmtState state = NmtState::operational) const {
    dut_.send(0x700U + node_.value(), Bytes{static_cast<std::uint8_t>(state)});
    return dut_.now();
  }

  /// Sends `count` heartbeats with this period and returns the time of the last one.
  std::uint64_t beats(Duration period, unsigned count) const {
    std::uint64_t last = beat();
    for (unsigned i = 1; i < count; ++i) {
      dut_.pass_time(period);
      last = beat();
    }
    return last;
  }

 private:
  Dut& dut_;
  NodeId node_;
};

constexpr Duration watched = milliseconds{200};

/// Expects the heartbeat event: an EMCY with 8130h one consumer heartbeat time after the last heartbeat.
void expect_lost(Dut& dut, const Dut::Match& event, Dut::Mark since, std::uint64_t last) {
  const auto seen = dut.wait_for(event, watched * 3, since);
  dut.expect(seen.has_value(), "an EMCY with code 8130h after the consumer heartbeat time of 200 ms", "none");
  dut.expect_time(seen->at - last, watched.count(), watched.count() * 5 / 4, "the EMCY after the last heartbeat");
}

void expect_not_lost(Dut& dut, const Dut::Match& event, Dut::Mark since, const std::string& when) {
  dut.expect(dut.received_since(since, event).empty(), "no EMCY with code 8130h " + when, "one");
}

void duplicate_consumer(Dut& dut) {
  dut.need_writable(consumer_time, 2);
  const Producer producer{dut};
  producer.watch(watched);
  producer.watch(watched);
  const std::uint64_t before = dut.read_number(consumer_time, 2);
  dut.expect_equal(dut.read_number(consumer_time, 1), producer.value(watched), "1016h:01");
  dut.expect_abort(dut.download(consumer_time, 2, producer.value(watched)), abort_rule::duplicate,
                   "the node-ID of 1016h:01 written to 1016h:02");
  dut.expect_equal(dut.read_number(consumer_time, 2), before, "1016h:02 afterwards");
}

void heartbeats_in_time(Dut& dut) {
  const Producer producer{dut};
  const Dut::Match event = error_control_event(dut);
  const Dut::Mark since = dut.mark();
  producer.watch(watched);
  dut.pass_time(watched * 3);
  expect_not_lost(dut, event, since, "before the first heartbeat");
  const std::uint64_t last = producer.beats(watched / 2, 12);
  expect_not_lost(dut, event, since, "while heartbeats are sent every 100 ms");
  expect_lost(dut, event, since, last);
}

void heartbeats_too_late(Dut& dut) {
  const Producer producer{dut};
  const Dut::Match event = error_control_event(dut);
  producer.watch(watched);
  for (unsigned i = 0; i < 2; ++i) {
    const Dut::Mark since = dut.mark();
    expect_lost(dut, event, since, producer.beat());
    dut.pass_time(watched * 2);
    dut.expect_equal(dut.received_since(since, event).size(), 1, "EMCYs with code 8130h for one lost node");
  }
}

void consumer_after_reset(Dut& dut) {
  const Producer producer{dut};
  const Dut::Match event = error_control_event(dut);
  producer.watch(watched);
  (void)producer.beats(watched / 2, 3);
  Dut::Mark since = dut.mark();
  dut.reset(NmtCommand::reset_node);
  dut.pass_time(watched * 3);
  const std::uint64_t started = dut.received_since(since, dut.boot_up()).back().at;
  for (const SeenFrame& seen : dut.received_since(since, event)) {
    dut.expect(seen.at < started, "no EMCY with code 8130h after a reset, before the first heartbeat", "one");
  }
  since = dut.mark();
  producer.watch(watched);
  dut.pass_time(watched * 3);
  expect_not_lost(dut, event, since, "before the first heartbeat");
  expect_lost(dut, event, since, producer.beat());
}

// ---- heartbeat and guarding ----

void need_both(Dut& dut) {
  dut.need_writable(guard_time);
  dut.need_writable(life_time_factor);
  dut.need_writable(producer_time);
}

/// Writes 100Ch and 100Dh: 0 disables life guarding.
void set_guarding(Dut& dut, std::uint16_t milliseconds_between, std::uint8_t factor) {
  dut.write(guard_time, 0, milliseconds_between);
  dut.write(life_time_factor, 0, factor);
}

void one_of_both(Dut& dut) {
  const bool guarding = dut.has(guard_time) && dut.has(life_time_factor);
  if (!guarding && !dut.has(producer_time)) {
    dut.fail_by_sheet("error-control", "1017h, or 100Ch and 100Dh", "the EDS has neither");
  }
  for (const std::uint16_t index : {guard_time, life_time_factor, producer_time}) {
    if (dut.has(index)) (void)dut.read_number(index);
  }
}

void heartbeat_off(Dut& dut) {
  need_both(dut);
  start_heartbeat(dut);
  dut.write(producer_time, 0, 0);
  dut.expect_equal(dut.read_number(producer_time), 0, "1017h:00");
  expect_no_heartbeats(dut);
}

void guarding_without_heartbeat(Dut& dut) {
  need_both(dut);
  start_heartbeat(dut);
  dut.write(producer_time, 0, 0);
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
  if (dut.has(0x1014)) expect_not_lost(dut, error_control_event(dut), since, "while 1017h:00 is not 0");
}

void requests_with_guarding(Dut& dut) {
  need_both(dut);
  set_guarding(dut, 100, 2);
  start_heartbeat(dut);
  const Dut::Mark since = dut.mark();
  expect_requests_ignored(dut);
  dut.pass_time(beat * 5);
  if (dut.has(0x1014)) expect_not_lost(dut, error_control_event(dut), since, "while 1017h:00 is not 0");
}

constexpr CaseRow rows[] = {
    {"7.1", "100Ch and 100Dh can be read", "CiA 301, 7.5.2.11 and 7.5.2.12", Level::communication, Permission::none,
     read_guarding},
    {"7.2", "A remote frame of node guarding is answered once, with the NMT state", "CiA 301, 7.2.8.3.2.1",
     Level::communication, Permission::none, answer},
    {"7.3", "The toggle bit is 0 after a reset and alternates", "CiA 301, 7.2.8.3.2.1", Level::communication,
     Permission::none, toggle},
    {"7.4", "Remote frames of node guarding for other node-IDs are not answered", "CiA 301, 7.2.8.3.2.1 and 7.3.5",
     Level::communication, Permission::none, foreign_requests},
    {"7.5", "100Ch and 100Dh keep the written values", "CiA 301, 7.5.2.11 and 7.5.2.12", Level::communication,
     Permission::none, write_guarding},
    {"7.6", "After a node life time without guarding requests the device sends an EMCY with code 8130h",
     "CiA 301, 7.2.8.3.2.1", Level::communication, Permission::none, life_guarding},
    {"7.101", "1017h keeps the written values", "CiA 301, 7.5.2.20", Level::communication, Permission::none,
     write_heartbeat},
    {"7.102", "The device sends a heartbeat with the NMT state in each period of 1017h", "CiA 301, 7.2.8.3.2.2",
     Level::communication, Permission::none, count_heartbeats},
    {"7.103", "With 1017h = 0 the device sends no heartbeat", "CiA 301, 7.5.2.20", Level::communication,
     Permission::none, stop_heartbeat},
    {"7.104", "1016h refuses a second entry for the same node", "CiA 301, 7.5.2.19", Level::communication,
     Permission::none, duplicate_consumer},
    {"7.105", "A node whose heartbeats are in time is not reported as lost", "CiA 301, 7.2.8.2.2 and 7.5.2.19",
     Level::communication, Permission::none, heartbeats_in_time},
    {"7.106", "A node whose heartbeat is late is reported as lost after the time of 1016h",
     "CiA 301, 7.2.8.2.2 and 7.5.2.19", Level::communication, Permission::none, heartbeats_too_late},
    {"7.107", "After a reset a node is monitored from its first heartbeat on", "CiA 301, 7.2.8.2.2 and 7.5.2.19",
     Level::communication, Permission::none, consumer_after_reset},
    {"7.201", "The device has heartbeat or node guarding", "CiA 301, 7.2.8.3.2", Level::communication, Permission::none,
     one_of_both},
    {"7.202", "A device with heartbeat and node guarding stops its heartbeat if 1017h = 0", "CiA 301, 7.5.2.20",
     Level::communication, Permission::none, heartbeat_off},
    {"7.203", "Without heartbeat the device answers node guarding", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, guarding_without_heartbeat},
    {"7.204", "With 100Ch and 100Dh = 0 the device sends heartbeats", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, heartbeat_without_guarding},
    {"7.205", "While heartbeat is active a remote frame is not answered", "CiA 301, 7.2.8.3.2", Level::communication,
     Permission::none, requests_without_guarding},
    {"7.206", "With 100Ch and 100Dh set the device sends heartbeats, without a life guarding event",
     "CiA 301, 7.2.8.3.2", Level::communication, Permission::none, heartbeat_with_guarding},
    {"7.207", "With 100Ch and 100Dh set a remote frame is not answered while heartbeat is active", "CiA 301, 7.2.8.3.2",
     Level::communication, Permission::none, requests_with_guarding},
};

}  // namespace
}  // namespace error_control_area

std::span<const CaseRow> error_control_cases() { return error_control_area::rows; }

}  // namespace edsc::conform
