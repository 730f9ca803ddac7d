/// Transmission of TPDOs (CiA 301, 7.2.2.2 and 7.5.2.37): in Operational according to their parameters, in other states
/// not at all (7.3.2.2.5, table 37).
#include <fmt/format.h>

#include <algorithm>
#include <canopen/nmt/nmt.hpp>
#include <memory>
#include <utility>

#include "conform/cases/pdo_area.hpp"
#include "conform/cases/pdo_cases.hpp"

namespace edsc::conform::pdo_area {
namespace {

/// The delay of a TPDO by other frames on the bus.
constexpr std::uint32_t wire_us = 1'000;

/// Records whether a case has tested a TPDO, and why it did not test others.
class Tested {
 public:
  explicit Tested(Dut& dut) : dut_{dut} {}

  /// Configures the TPDO. Returns whether the case can test it.
  [[nodiscard]] bool configured(const Tpdo& tpdo, const Transmission& wanted) {
    if (auto why = configure(dut_, tpdo, wanted)) {
      if (reason_.empty()) reason_ = tpdo.name() + ": " + *why;
      return false;
    }
    any_ = true;
    return true;
  }
  void need_one() {
    if (!any_) dut_.not_applicable(reason_);
  }

 private:
  Dut& dut_;
  bool any_ = false;
  std::string reason_;
};

/// Runs a check in Operational for each TPDO that can be configured. Not applicable without one.
template <class Check>
void for_each_tpdo(Dut& dut, const std::vector<Transmission>& transmissions, Check check) {
  Tested tested{dut};
  for (const Tpdo& tpdo : tpdos(dut)) {
    for (const Transmission& wanted : transmissions) {
      dut.enter(NmtState::pre_operational);
      if (!tested.configured(tpdo, wanted)) continue;
      dut.enter(NmtState::operational);
      check(tpdo, wanted);
      dut.enter(NmtState::pre_operational);
      put_back(dut, tpdo);
    }
  }
  tested.need_one();
}

void expect_none(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, const std::string& when) {
  dut.expect(frames.empty(), fmt::format("no {} {}", tpdo.name(), when), frames_text(frames));
}

/// Whether the values of the TPDO change by themselves, so that its events cannot be counted. Fails for a TPDO without
/// a change, because it is sent without an event.
bool changes_by_itself(Dut& dut, const Tpdo& tpdo) {
  const std::vector<SeenFrame> frames = dut.collect(tpdo.frames(), 2 * silence);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool is_same = frames[i].frame == frames[i - 1].frame;
    dut.expect(!is_same, fmt::format("no {} without an event", tpdo.name()),
               frame_text(frames[i].frame) + " twice with the same data");
  }
  return !frames.empty();
}

SeenFrame expect_frame(Dut& dut, const Tpdo& tpdo, Dut::Mark since, Duration longest, const std::string& when) {
  const auto seen = dut.wait_for(tpdo.frames(), longest, since);
  dut.expect(seen.has_value(), fmt::format("{} {}", tpdo.name(), when),
             fmt::format("no frame within {} ms", longest.count() / 1000));
  return *seen;
}

[[noreturn]] void no_stimulus(Dut& dut, const Tpdo& tpdo) {
  dut.inconclusive(
      fmt::format("no stimulus changes an object of {} ({}); use --stimulus with a command that changes one",
                  tpdo.name(), objects_text(tpdo.mapping)));
}

// ---- remote frames ----

/// Whether node guarding shows that the bus transmits remote frames.
bool answers_node_guarding(Dut& dut) {
  if (!dut.has(0x100C) || (dut.has(0x1017) && dut.read_number(0x1017) != 0)) return false;
  const Dut::Mark since = dut.mark();
  dut.send_remote(0x700U + dut.node().value(), 1);
  return dut.wait_for(dut.error_control(), to_answer, since).has_value();
}

SeenFrame ask(Dut& dut, const Tpdo& tpdo, bool bus_is_known) {
  const Dut::Mark since = dut.mark();
  dut.send(make_remote_frame(tpdo.cob_id, tpdo.size()));
  if (dut.wait_for(tpdo.frames(), to_answer, since)) {
    dut.pass_time(silence);
    const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
    dut.expect(all.size() == 1, fmt::format("one {} after a remote frame", tpdo.name()), frames_text(all));
    return all.front();
  }
  if (!bus_is_known && !dut.simulated() && !answers_node_guarding(dut)) {
    dut.inconclusive(tpdo.name() +
                     " does not answer a remote frame, and it is unknown whether the bus transmits remote frames");
  }
  dut.fail(tpdo.name() + " after a remote frame", fmt::format("no frame within {} ms", to_answer.count() / 1000));
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
void expect_sample_of_sync(Dut& dut, const Tpdo& tpdo, bool bus_is_known) {
  SyncSource sync{dut};
  Event event{dut, tpdo.mapping};
  Image at_sync = read_image(dut, tpdo.mapping);
  expect_none(dut, tpdo, sync.send_and_collect(tpdo.frames()), "at a SYNC, without a remote frame");
  const Image after_sync = read_image(dut, tpdo.mapping);
  at_sync.known &= ~(at_sync.bits ^ after_sync.bits);
  (void)event.apply();
  expect_data(dut, tpdo, ask(dut, tpdo, bus_is_known), at_sync);
}

}  // namespace

void sends_on_remote_frame(Dut& dut) {
  bool bus_is_known = false;
  std::vector<Transmission> transmissions{{.type = remote, .remote_frames = true}, {.remote_frames = true}};
  if (dut.has(0x1005) && dut.allowed(Permission::outputs)) {
    transmissions.push_back({.type = remote_synchronous, .remote_frames = true});
  }
  for_each_tpdo(dut, transmissions, [&](const Tpdo& tpdo, const Transmission& wanted) {
    const bool only_when_asked = wanted.type != event_driven;
    if (!only_when_asked) settle(dut, tpdo);
    const bool changes = changes_by_itself(dut, tpdo);
    dut.expect(!(changes && only_when_asked),
               fmt::format("no {} of type {} without a remote frame", tpdo.name(), wanted.type), "a frame without one");
    if (changes) return;
    if (wanted.type == remote_synchronous) return expect_sample_of_sync(dut, tpdo, bus_is_known);
    for (int i = 0; i < 2; ++i) {
      const Image before = read_image(dut, tpdo.mapping);
      expect_present_data(dut, tpdo, ask(dut, tpdo, bus_is_known), before);
      bus_is_known = true;
    }
    if (!only_when_asked) expect_no_answer_where_not_allowed(dut, tpdo, wanted);
  });
}

// ---- events ----

namespace {

/// Changes the objects of the TPDO one by one until `is_sent` returns that the change was an event: some objects do not
/// cause events. Returns false if no stimulus has changed a value that SDO reads.
template <class IsSent>
bool find_event(Dut& dut, const Tpdo& tpdo, Event& event, IsSent is_sent) {
  bool has_changed = false;
  do {
    const Image before = read_image(dut, tpdo.mapping);
    const Dut::Mark since = dut.mark();
    if (!event.apply()) break;
    if (is_sent(since)) return true;
    has_changed = has_changed || read_image(dut, tpdo.mapping).bits != before.bits;
  } while (event.use_next());
  return has_changed;
}

/// Expects that an event sends the TPDO once, with the new values.
void expect_event(Dut& dut, const Tpdo& tpdo, Event& event, bool counts) {
  const Dut::Mark since = dut.mark();
  if (!event.apply()) no_stimulus(dut, tpdo);
  const std::string when = fmt::format("after {} has changed", event.object());
  const SeenFrame seen = expect_frame(dut, tpdo, since, to_answer, when);
  if (!counts) return;
  expect_present_data(dut, tpdo, seen, read_image(dut, tpdo.mapping));
  dut.pass_time(silence);
  const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
  dut.expect(all.size() == 1, fmt::format("one {} {}", tpdo.name(), when), frames_text(all));
}

constexpr std::uint16_t inhibit_time = 1000;  ///< 100 ms
constexpr std::uint32_t inhibit_us = 100'000;

/// Expects the inhibit time between two frames, and that the second event is not lost.
void expect_inhibit_time(Dut& dut, const Tpdo& tpdo, Event& event, bool counts) {
  const Dut::Mark since = dut.mark();
  if (!event.apply()) no_stimulus(dut, tpdo);
  (void)expect_frame(dut, tpdo, since, to_answer, "after an event");
  const Dut::Mark after_first = dut.mark();
  if (!event.apply()) no_stimulus(dut, tpdo);
  const Duration longest = to_answer + Duration{inhibit_us};
  const SeenFrame last = expect_frame(dut, tpdo, after_first, longest, "after an event within the inhibit time");
  const std::vector<SeenFrame> all = dut.received_since(since, tpdo.frames());
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::uint64_t time = all[i].at - all[i - 1].at;
    dut.expect_time(time, inhibit_us - wire_us, std::max<std::uint64_t>(time, longest.count()),
                    fmt::format("time between two {} with an inhibit time", tpdo.name()));
  }
  if (counts) expect_present_data(dut, tpdo, last, read_image(dut, tpdo.mapping));
}

}  // namespace

void sends_on_event(Dut& dut) {
  std::optional<Tpdo> without_stimulus;
  bool any = false;
  for_each_tpdo(dut, {Transmission{}}, [&](const Tpdo& tpdo, const Transmission&) {
    settle(dut, tpdo);
    const bool changes = changes_by_itself(dut, tpdo);
    Event event{dut, tpdo.mapping};
    if (!find_event(dut, tpdo, event,
                    [&](Dut::Mark since) { return dut.wait_for(tpdo.frames(), to_answer, since).has_value(); })) {
      without_stimulus = tpdo;
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
  if (!any && without_stimulus) no_stimulus(dut, *without_stimulus);
}

// ---- event timer ----

namespace {

/// A period that the EDS allows.
std::uint16_t timer_of(const Dut& dut, const Tpdo& tpdo) {
  constexpr std::uint16_t wanted_ms = 100;
  return static_cast<std::uint16_t>(within_limits(dut, tpdo.index, timer_parameter, wanted_ms));
}

/// The event timer is the maximum time between two frames; without a change also the minimum time.
void expect_period(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, std::uint64_t period_us) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool may_be_event = i == 1 || !(frames[i].frame == frames[i - 1].frame);
    dut.expect_time(frames[i].at - frames[i - 1].at, may_be_event ? 0 : period_us - wire_us, period_us + wire_us,
                    fmt::format("time between two {} with an event timer of {} ms", tpdo.name(), period_us / 1000));
  }
}

}  // namespace

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
               frames_text(frames));
    expect_period(dut, tpdo, frames, period_us);
    expect_present_data(dut, tpdo, frames.back(), before);
    if (within_limits(dut, tpdo.index, timer_parameter, 0) == 0) {
      dut.write(tpdo.index, timer_parameter, 0);
      settle(dut, tpdo);
      (void)changes_by_itself(dut, tpdo);
    }
    dut.enter(NmtState::pre_operational);
    put_back(dut, tpdo);
  }
  tested.need_one();
}

// ---- SYNC ----

namespace {

/// Sends one SYNC and returns whether the TPDO follows: once, and within the synchronous window if one is set.
bool is_sent_at_sync(Dut& dut, const Tpdo& tpdo, SyncSource& sync, std::uint64_t window_us) {
  const Image before = read_image(dut, tpdo.mapping);
  const std::vector<SeenFrame> frames = sync.send_and_collect(tpdo.frames());
  dut.expect(frames.size() <= 1, fmt::format("at most one {} after a SYNC", tpdo.name()), frames_text(frames));
  if (frames.empty()) return false;
  expect_present_data(dut, tpdo, frames.front(), before);
  if (window_us != 0) {
    dut.expect_time(frames.front().at - sync.sent_at(), 0, window_us + wire_us,
                    fmt::format("time from SYNC to {} with the window of 1007h:00", tpdo.name()));
  }
  return true;
}

std::uint64_t sync_window(Dut& dut) {
  const Entry* const window = dut.entry(0x1007);
  return window != nullptr && canopen::readable(window->access) ? dut.read_number(0x1007) : 0;
}

/// Type n: at every n-th SYNC, and not without a SYNC.
void expect_each_nth(Dut& dut, const Tpdo& tpdo, SyncSource& sync, unsigned n) {
  constexpr unsigned rounds = 3;
  expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "without a SYNC");
  const std::uint64_t window_us = sync_window(dut);
  std::optional<unsigned> last;
  unsigned count = 0;
  for (unsigned i = 1; i <= rounds * n; ++i) {
    if (!is_sent_at_sync(dut, tpdo, sync, window_us)) continue;
    const unsigned distance = last ? i - *last : n;
    dut.expect(distance == n, fmt::format("{} of type {} every {} SYNCs", tpdo.name(), n, n),
               fmt::format("two of them {} SYNCs apart", distance));
    last = i;
    ++count;
  }
  dut.expect(count == rounds, fmt::format("{} of type {} {} times after {} SYNCs", tpdo.name(), n, rounds, rounds * n),
             fmt::format("{} times", count));
  expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "without a SYNC");
}

}  // namespace

void sends_at_each_nth_sync(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  for_each_tpdo(dut, {{.type = 1}, {.type = 3}},
                [&](const Tpdo& tpdo, const Transmission& wanted) { expect_each_nth(dut, tpdo, sync, wanted.type); });
}

void sends_at_sync_after_event(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  std::optional<Tpdo> without_stimulus;
  bool any = false;
  for_each_tpdo(dut, {{.type = acyclic}}, [&](const Tpdo& tpdo, const Transmission&) {
    (void)sync.send_and_collect(tpdo.frames());  // entering Operational may be an event
    Image before = read_image(dut, tpdo.mapping);
    for (int i = 0; i < 3; ++i) {
      const std::vector<SeenFrame> frames = sync.send_and_collect(tpdo.frames());
      const Image after = read_image(dut, tpdo.mapping);
      if (after.bits == before.bits) expect_none(dut, tpdo, frames, "of type 0 at a SYNC without an event before it");
      before = after;
    }
    Event event{dut, tpdo.mapping};
    bool sent = false;
    const bool found = find_event(dut, tpdo, event, [&](Dut::Mark) {
      expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "of type 0 between an event and the next SYNC");
      return sent = is_sent_at_sync(dut, tpdo, sync, sync_window(dut));
    });
    if (!found) {
      without_stimulus = tpdo;
      return;
    }
    any = true;
    dut.expect(sent, fmt::format("{} of type 0 at the SYNC after {} has changed", tpdo.name(), event.object()),
               "no frame");
    expect_none(dut, tpdo, sync.send_and_collect(tpdo.frames()), "of type 0 at the second SYNC after an event");
  });
  if (!any && without_stimulus) no_stimulus(dut, *without_stimulus);
}

namespace {

/// A SYNC start value that the counter reaches after a few SYNCs.
struct SyncStart {
  std::uint8_t value;
  std::uint8_t first;  ///< the counter of the first SYNC
};

SyncStart sync_start_of(const SyncSource& sync) {
  constexpr std::uint8_t value = 3, lead = 4;
  const std::uint8_t overflow = sync.overflow();
  if (overflow <= value) return {overflow, 1};
  return {value, static_cast<std::uint8_t>(std::max<int>(value + 1, overflow - lead))};
}

}  // namespace

void sends_from_sync_start_value(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut, SyncSource::Counter::enabled};
  const SyncStart start = sync_start_of(sync);
  for_each_tpdo(dut, {{.type = 1, .sync_start = start.value}}, [&](const Tpdo& tpdo, const Transmission&) {
    std::uint8_t counter = start.first;
    sync.set_next(counter);
    for (; counter != start.value;
         counter = counter < sync.overflow() ? static_cast<std::uint8_t>(counter + 1) : std::uint8_t{1}) {
      expect_none(dut, tpdo, sync.send_and_collect(tpdo.frames()),
                  fmt::format("at the SYNC with counter {}, before the SYNC start value {}", counter, start.value));
    }
    for (int i = 0; i < 3; ++i) {
      dut.expect(is_sent_at_sync(dut, tpdo, sync, sync_window(dut)),
                 fmt::format("{} at each SYNC beginning with counter {}", tpdo.name(), start.value), "no frame");
    }
  });
}

// ---- not Operational ----

namespace {

/// Configures all TPDOs that support the parameters, in Pre-operational. Not applicable without one.
std::vector<Tpdo> configure_all(Dut& dut, const Transmission& wanted) {
  Tested tested{dut};
  std::vector<Tpdo> done;
  for (Tpdo& tpdo : tpdos(dut)) {
    if (tested.configured(tpdo, wanted)) done.push_back(std::move(tpdo));
  }
  tested.need_one();
  return done;
}

/// Enters the state through Operational, where timers start, calls `provoke`, and expects no TPDO.
template <class Provoke>
void expect_silence(Dut& dut, NmtState state, const std::vector<Tpdo>& tested, const std::string& when,
                    Provoke provoke) {
  dut.enter(NmtState::operational);
  dut.enter(state);
  const Dut::Mark since = dut.mark();
  provoke();
  dut.pass_time(silence);
  for (const Tpdo& tpdo : tested) {
    expect_none(dut, tpdo, dut.received_since(since, tpdo.frames()),
                fmt::format("in NMT state {} {}", canopen::to_text(state), when));
  }
}

/// Events for all TPDOs. Inconclusive without a stimulus for one of them.
class Events {
 public:
  Events(Dut& dut, const std::vector<Tpdo>& tested) : dut_{dut}, first_{tested.front()} {
    for (const Tpdo& tpdo : tested) events_.push_back(std::make_unique<Event>(dut, tpdo.mapping));
  }
  void apply() {
    bool any = false;
    for (const auto& event : events_) any = event->apply() || any;
    if (!any) no_stimulus(dut_, first_);
  }

 private:
  Dut& dut_;
  const Tpdo& first_;
  std::vector<std::unique_ptr<Event>> events_;
};

constexpr int several = 4;

}  // namespace

void silent_on_remote_frame(Dut& dut, NmtState state) {
  dut.enter(NmtState::pre_operational);
  std::vector<Tpdo> tested;
  std::string reason;
  for (Tpdo& tpdo : tpdos(dut)) {
    auto why = configure(dut, tpdo, {.type = remote, .remote_frames = true});
    if (why) why = configure(dut, tpdo, {.remote_frames = true});
    if (why && reason.empty()) reason = tpdo.name() + ": " + *why;
    if (!why) tested.push_back(std::move(tpdo));
  }
  if (tested.empty()) dut.not_applicable(reason);
  expect_silence(dut, state, tested, "after a remote frame", [&] {
    for (const Tpdo& tpdo : tested) dut.send(make_remote_frame(tpdo.cob_id, tpdo.size()));
  });
}

void silent_on_event(Dut& dut, NmtState state) {
  const std::vector<Tpdo> tested = configure_all(dut, {});
  Events events{dut, tested};
  expect_silence(dut, state, tested, "after an event", [&] { events.apply(); });
}

void silent_by_event_timer(Dut& dut, NmtState state) {
  Tested tested{dut};
  std::vector<Tpdo> done;
  std::uint32_t longest_ms = 0;
  dut.enter(NmtState::pre_operational);
  for (Tpdo& tpdo : tpdos(dut)) {
    const std::uint16_t timer = timer_of(dut, tpdo);
    if (!tested.configured(tpdo, {.event_timer = timer})) continue;
    longest_ms = std::max<std::uint32_t>(longest_ms, timer);
    done.push_back(std::move(tpdo));
  }
  tested.need_one();
  expect_silence(dut, state, done, "by its event timer", [&] { dut.pass_time(Duration{3000 * longest_ms}); });
}

void silent_at_sync(Dut& dut, NmtState state) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  const std::vector<Tpdo> tested = configure_all(dut, {.type = 1});
  expect_silence(dut, state, tested, "after SYNC", [&] {
    for (int i = 0; i < several; ++i) (void)sync.send_and_collect(tested.front().frames());
  });
}

void silent_at_sync_after_event(Dut& dut, NmtState state) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  const std::vector<Tpdo> tested = configure_all(dut, {.type = acyclic});
  Events events{dut, tested};
  expect_silence(dut, state, tested, "after an event and SYNC", [&] {
    events.apply();
    for (int i = 0; i < several; ++i) (void)sync.send_and_collect(tested.front().frames());
  });
}

void silent_from_sync_start_value(Dut& dut, NmtState state) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut, SyncSource::Counter::enabled};
  constexpr std::uint8_t first = 1;
  const std::vector<Tpdo> tested = configure_all(dut, {.type = 1, .sync_start = first});
  expect_silence(dut, state, tested, "after the SYNC with the SYNC start value", [&] {
    sync.set_next(first);
    for (int i = 0; i < several; ++i) (void)sync.send_and_collect(tested.front().frames());
  });
}

}  // namespace edsc::conform::pdo_area
