/// TPDOs in Operational that follow a remote frame, an event or the event timer (CiA 301, 7.2.2.2 and 7.5.2.37).
#include <fmt/format.h>

#include <algorithm>

#include "conform/case.hpp"
#include "conform/cases/nmt/error_control.hpp"
#include "conform/cases/pdo/tested_tpdos.hpp"

namespace edsc::conform {
namespace {

// ---- remote frames ----

/// Notes whether the bus carries remote frames, as node guarding shows.
void note_node_guarding(Dut& dut) {
  if (!dut.has(guard_time) || !dut.has(life_time_factor)) return;
  configure_guarding(dut);
  if (!answers(dut).empty()) dut.note_remote_frame_answered();
}

SeenFrame ask(Dut& dut, const Tpdo& tpdo) {
  const Dut::Mark since = dut.mark();
  dut.send(make_remote_frame(tpdo.cob_id, tpdo.size()));
  if (dut.wait_for(tpdo.frames(), to_send, since)) {
    dut.pass_time(silence);
    const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
    dut.expect(all.size() == 1, fmt::format("one {} after a remote frame", tpdo.name()), frames_text(all), all);
    dut.note_remote_frame_answered();
    return all.front();
  }
  note_node_guarding(dut);
  dut.fail(tpdo.name() + " after a remote frame", fmt::format("no frame within {} ms", to_send.count() / 1000));
}

/// With bit 30 of the COB-ID set, a remote frame is not answered.
void expect_no_answer_where_not_allowed(Dut& dut, const Tpdo& tpdo, Transmission wanted) {
  wanted.remote_frames = false;
  if (configure(dut, tpdo, wanted)) return;
  settle(dut, tpdo);
  if (changes_by_itself(dut, tpdo)) return;
  dut.send(make_remote_frame(tpdo.cob_id, tpdo.size()));
  expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "after a remote frame that bit 30 of its COB-ID forbids");
}

/// Type 252: the TPDO has the values at the last SYNC.
void expect_sample_of_sync(Dut& dut, const Tpdo& tpdo) {
  SyncSource sync{dut};
  Event event{dut, tpdo.mapping};
  Image at_sync = read_image(dut, tpdo.mapping);
  expect_none(dut, tpdo, sync.send_and_collect(tpdo.frames()), "at a SYNC, without a remote frame");
  const Image after_sync = read_image(dut, tpdo.mapping);
  at_sync.known &= ~(at_sync.bits ^ after_sync.bits);
  (void)event.apply();
  expect_data(dut, tpdo, ask(dut, tpdo), at_sync);
}

// ---- events ----

/// Changes an object. An application that writes its own value over the change leaves no event to count.
void cause_event(Dut& dut, const Tpdo& tpdo, Event& event) {
  event.read_back();
  if (!event.apply()) no_stimulus(dut, tpdo, false);
}

/// The frames after one event. Two with the same data are one too many. Another value is a change by the application,
/// such as a sensor that writes its measured value.
void expect_one_event(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, const std::string& when) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    dut.expect(!(frames[i].frame == frames[i - 1].frame), fmt::format("one {} {}", tpdo.name(), when),
               frames_text(frames), frames);
  }
}

/// Expects that an event sends the TPDO once, with the new values.
void expect_event(Dut& dut, const Tpdo& tpdo, Event& event, bool counts) {
  const Dut::Mark since = dut.mark();
  cause_event(dut, tpdo, event);
  const std::string when = fmt::format("after {} has changed", event.object());
  if (!dut.wait_for(tpdo.frames(), to_send, since) && !event.read_back()) {
    dut.inconclusive(Condition::usable_value,
                     fmt::format("the device overwrites {}, which the stimulus changes", event.object()));
  }
  (void)expect_frame(dut, tpdo, since, Duration{0}, when);
  if (!counts) return;
  dut.pass_time(silence);
  const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
  expect_one_event(dut, tpdo, all, when);
  expect_present_data(dut, tpdo, all.back(), read_image(dut, tpdo.mapping));
}

constexpr std::uint16_t inhibit_time = 1000;  ///< 100 ms
constexpr std::uint32_t inhibit_us = 100'000;

/// Expects the inhibit time between two frames, and that the second event is not lost.
void expect_inhibit_time(Dut& dut, const Tpdo& tpdo, Event& event, bool counts) {
  const Dut::Mark since = dut.mark();
  cause_event(dut, tpdo, event);
  const SeenFrame first = expect_frame(dut, tpdo, since, to_send, "after an event");
  const Dut::Mark after_first = dut.mark();
  cause_event(dut, tpdo, event);
  if (dut.now() >= first.at + inhibit_us - wire_us) {
    dut.inconclusive(Condition::stimulus, "the second stimulus came after the inhibit time of 100 ms");
  }
  const Duration longest = to_send + Duration{inhibit_us};
  const SeenFrame last = expect_frame(dut, tpdo, after_first, longest, "after an event within the inhibit time");
  const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::uint64_t time = all[i].at - all[i - 1].at;
    dut.expect_time(time, inhibit_us - wire_us, std::max<std::uint64_t>(time, longest.count()),
                    fmt::format("time between two {} with an inhibit time", tpdo.name()));
  }
  if (counts) expect_present_data(dut, tpdo, last, read_image(dut, tpdo.mapping));
}

/// The event timer is the maximum time between two frames; without a change also the minimum time.
void expect_period(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, std::uint64_t period_us) {
  const std::string what =
      fmt::format("time between two {} with an event timer of {} ms", tpdo.name(), period_us / 1000);
  std::vector<std::uint64_t> of_timer, all;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool may_be_event = i == 1 || !(frames[i].frame == frames[i - 1].frame);
    all.push_back(frames[i].at - frames[i - 1].at);
    if (!may_be_event) of_timer.push_back(all.back());
  }
  dut.expect_times(all, 0, period_us + wire_us, what);
  dut.expect_times(of_timer, period_us - wire_us, period_us + wire_us, what);
}

void sends_on_remote_frame(Dut& dut) {
  std::vector<Transmission> transmissions{{.type = remote, .remote_frames = true}, {.remote_frames = true}};
  if (dut.has(sync_cob_id) && dut.allowed(Permission::outputs)) {
    transmissions.push_back({.type = remote_synchronous, .remote_frames = true});
  }
  for_each_tpdo(dut, transmissions, [&](const Tpdo& tpdo, const Transmission& wanted) {
    const bool only_when_asked = wanted.type != event_driven;
    if (!only_when_asked) settle(dut, tpdo);
    const bool changes = changes_by_itself(dut, tpdo);
    dut.expect(!(changes && only_when_asked),
               fmt::format("no {} of type {} without a remote frame", tpdo.name(), wanted.type), "a frame without one");
    if (changes) return;
    if (wanted.type == remote_synchronous) return expect_sample_of_sync(dut, tpdo);
    for (int i = 0; i < 2; ++i) {
      const Image before = read_image(dut, tpdo.mapping);
      expect_present_data(dut, tpdo, ask(dut, tpdo), before);
    }
    if (!only_when_asked) expect_no_answer_where_not_allowed(dut, tpdo, wanted);
  });
}

void sends_on_event(Dut& dut) {
  std::optional<WithoutEvent> without_event;
  bool any = false;
  for_each_tpdo(dut, {Transmission{}}, [&](const Tpdo& tpdo, const Transmission&) {
    settle(dut, tpdo);
    const bool changes = changes_by_itself(dut, tpdo);
    Event event{dut, tpdo.mapping};
    if (!find_event(dut, tpdo, event,
                    [&](Dut::Mark since) { return dut.wait_for(tpdo.frames(), to_send, since).has_value(); })) {
      without_event = {tpdo, event.has_run()};
      return;
    }
    settle(dut, tpdo);
    expect_event(dut, tpdo, event, !changes);
    expect_event(dut, tpdo, event, !changes);
    any = true;
    if (configure(dut, tpdo, {.inhibit_time = inhibit_time})) return;
    settle(dut, tpdo);
    dut.pass_time(Duration{inhibit_us});
    expect_inhibit_time(dut, tpdo, event, !changes);
  });
  if (!any && without_event) no_stimulus(dut, without_event->tpdo, without_event->stimulus_has_run);
}

void sends_by_event_timer(Dut& dut) {
  Tested tested{dut};
  for (const Tpdo& tpdo : tpdos(dut)) {
    dut.enter(NmtState::pre_operational);
    const std::uint16_t timer = timer_of(dut, tpdo);
    if (!tested.configured(tpdo, {.event_timer = timer})) continue;
    const std::uint32_t period_us = timer * 1000U;
    const Dut::Mark since = dut.mark();
    dut.enter(NmtState::operational);
    const Image before = read_image(dut, tpdo.mapping);
    constexpr unsigned periods = 5;
    dut.pass_time(Duration{period_us * periods + period_us / 2});
    const std::vector<SeenFrame> frames = dut.received_since(since, tpdo.frames());
    dut.expect(frames.size() >= periods,
               fmt::format("{} {} times in {} periods of its event timer", tpdo.name(), periods, periods),
               frames_text(frames), frames);
    expect_period(dut, tpdo, frames, period_us);
    expect_present_data(dut, tpdo, frames.back(), before);
    if (within_limits(dut, tpdo.index, timer_parameter, 0) == 0) {
      dut.write(tpdo.index, timer_parameter, 0);
      settle(dut, tpdo);
      (void)changes_by_itself(dut, tpdo);
    }
    dut.enter(NmtState::pre_operational);
    restore(dut, tpdo);
  }
  tested.need_one();
}

constexpr CaseRow tpdo_event_rows[] = {
    {"3.3", "In Operational a remote frame is answered by its TPDO", "CiA 301, 7.2.2.3", with_writes, no_permission,
     sends_on_remote_frame, Condition::state | Condition::remote_frames},
    {"3.4", "In Operational a TPDO is sent once for each event, but not within its inhibit time", "CiA 301, 7.5.2.37",
     with_writes, no_permission, sends_on_event, Condition::state | Condition::stimulus | Condition::punctual},
    {"3.5", "In Operational a TPDO is sent when its event timer elapses", "CiA 301, 7.5.2.37", with_writes,
     no_permission, sends_by_event_timer, Condition::state | Condition::punctual},
};

}  // namespace

std::span<const CaseRow> tpdo_event_cases() { return tpdo_event_rows; }

}  // namespace edsc::conform
