/// Heartbeat producer and consumer (CiA 301, 7.2.8.3.2.2 and 7.2.8.2.2).
#include <fmt/format.h>

#include "conform/case.hpp"
#include "conform/cases/nmt/error_control.hpp"
#include "conform/cases/nmt/heartbeat_source.hpp"

namespace edsc::conform {
namespace {

constexpr Duration watched = milliseconds{200};

/// Expects the heartbeat event: an EMCY with 8130h one consumer heartbeat time after the last heartbeat.
void expect_lost(Dut& dut, const Dut::Match& event, Dut::Mark since, std::uint64_t last) {
  const auto seen = dut.wait_for(event, watched * 3, since);
  dut.expect(seen.has_value(), "an EMCY with code 8130h after the consumer heartbeat time of 200 ms", "none");
  dut.expect_time(seen->at - last, watched.count(), watched.count() * 5 / 4, "the EMCY after the last heartbeat");
}

// ---- heartbeat producer ----

void write_heartbeat(Dut& dut) {
  dut.need_writable(producer_heartbeat);
  for (const std::uint64_t time : {500U, 1000U, 0U}) {
    dut.write(producer_heartbeat, 0, time);
    const Bytes read = dut.read(producer_heartbeat);
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
  dut.write(producer_heartbeat, 0, 0);
  expect_no_heartbeats(dut);
}

// ---- heartbeat consumer ----

void duplicate_consumer(Dut& dut) {
  dut.need_writable(consumer_heartbeat, 2);
  const HeartbeatSource producer{dut};
  producer.watch(watched);
  producer.watch(watched);
  const std::uint64_t before = dut.read_number(consumer_heartbeat, 2);
  dut.expect_equal(dut.read_number(consumer_heartbeat, 1), producer.value(watched), "1016h:01");
  expect_refused(dut, consumer_heartbeat, 2, producer.value(watched), before, abort_rule::duplicate,
                 "the node-ID of 1016h:01 written to 1016h:02");
}

void heartbeats_in_time(Dut& dut) {
  const HeartbeatSource producer{dut};
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
  const HeartbeatSource producer{dut};
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
  const HeartbeatSource producer{dut};
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

/// A value of 0 in 1016h ends the monitoring.
void consumer_off(Dut& dut) {
  const HeartbeatSource producer{dut};
  const Dut::Match event = error_control_event(dut);
  producer.watch(watched);
  (void)producer.beats(watched / 2, 3);
  const Dut::Mark since = dut.mark();
  producer.unwatch();
  dut.pass_time(watched * 3);
  expect_not_lost(dut, event, since, "while 1016h:01 is 0");
}

/// The mean time between many heartbeats: a device whose timer starts anew with each heartbeat drifts.
void heartbeat_drift(Dut& dut) {
  constexpr std::size_t intervals = 40;
  start_heartbeat(dut);
  const std::vector<SeenFrame> seen = dut.collect(dut.heartbeat(), beat * (intervals + 2));
  dut.expect(seen.size() > intervals, fmt::format("more than {} heartbeats in {} periods", intervals, intervals + 2),
             std::to_string(seen.size()));
  const std::uint64_t mean = (seen.back().at - seen.front().at) / (seen.size() - 1);
  dut.expect_time(mean, beat.count() * 49 / 50, beat.count() * 51 / 50, "the mean time between heartbeats");
}

/// The first heartbeat is sent within one period after 1017h is written.
void first_heartbeat(Dut& dut) {
  dut.need_writable(producer_heartbeat);
  dut.enter(NmtState::pre_operational);
  dut.write(producer_heartbeat, 0, 0);
  constexpr Duration period = milliseconds{500};
  const Dut::Mark since = dut.mark();
  dut.write(producer_heartbeat, 0, period.count() / 1000);
  const std::uint64_t written = dut.now();
  const auto first = dut.wait_for(dut.heartbeat(), period * 3, since);
  dut.expect(first.has_value(), "a heartbeat after 1017h:00 is written", "none");
  dut.expect_time(first->at > written ? first->at - written : 0, 0, period.count() * 11 / 10,
                  "the first heartbeat after 1017h:00 is written");
}

constexpr CaseRow heartbeat_rows[] = {
    {"7.101", "1017h keeps the written values", "CiA 301, 7.5.2.20", Level::communication, Permission::none,
     write_heartbeat},
    {"7.102", "The device sends a heartbeat with the NMT state in each period of 1017h", "CiA 301, 7.2.8.3.2.2",
     Level::communication, Permission::none, count_heartbeats, Condition::punctual},
    {"7.103", "With 1017h = 0 the device sends no heartbeat", "CiA 301, 7.5.2.20", Level::communication,
     Permission::none, stop_heartbeat, Condition::punctual, "7.102"},
    {"7.104", "1016h refuses a second entry for the same node", "CiA 301, 7.5.2.19", Level::communication,
     Permission::none, duplicate_consumer},
    {"7.105", "A node is not reported as lost before its heartbeats, which were in time, have ended",
     "CiA 301, 7.2.8.2.2 and 7.5.2.19", Level::communication, Permission::none, heartbeats_in_time,
     Condition::punctual | Condition::alone, "7.106"},
    {"7.106", "A node whose heartbeat is late is reported as lost after the time of 1016h",
     "CiA 301, 7.2.8.2.2 and 7.5.2.19", Level::communication, Permission::none, heartbeats_too_late,
     Condition::punctual | Condition::alone},
    {"7.107", "After a reset a node is monitored from its first heartbeat on", "CiA 301, 7.2.8.2.2 and 7.5.2.19",
     Level::communication, Permission::none, consumer_after_reset, Condition::punctual | Condition::alone, "9.1"},
    {"7.108", "1016h = 0 ends the monitoring of a node", "CiA 301, 7.5.2.19", Level::communication, Permission::none,
     consumer_off, Condition::punctual | Condition::alone},
    {"7.109", "The heartbeats of the device do not drift from the time of 1017h", "CiA 301, 7.2.8.3.2.2 and 7.5.2.20",
     Level::communication, Permission::none, heartbeat_drift, Condition::punctual, "7.102"},
    {"7.110", "The first heartbeat is sent within the time that is written to 1017h", "CiA 301, 7.2.8.3.2.2",
     Level::communication, Permission::none, first_heartbeat, Condition::punctual},
};

}  // namespace

std::span<const CaseRow> heartbeat_cases() { return heartbeat_rows; }

}  // namespace edsc::conform
