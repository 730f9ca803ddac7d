/// TPDOs in Stopped and Pre-operational: none is sent (CiA 301, 7.3.2.2.5, table 37).
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "conform/case.hpp"
#include "conform/cases/pdo/tested_tpdos.hpp"

namespace edsc::conform {
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
    if (!any) no_stimulus(dut_, first_, false);
  }

 private:
  Dut& dut_;
  const Tpdo& first_;
  std::vector<std::unique_ptr<Event>> events_;
};

constexpr int several = 4;

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

constexpr NmtState stopped = NmtState::stopped, pre_operational = NmtState::pre_operational;

constexpr CaseRow tpdo_silence_rows[] = {
    {"3.9", "In Stopped a remote frame is not answered by a TPDO", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     with<silent_on_remote_frame, stopped>, Condition::state | Condition::remote_frames},
    {"3.10", "In Stopped no TPDO is sent for an event", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     with<silent_on_event, stopped>, Condition::state | Condition::stimulus},
    {"3.11", "In Stopped no TPDO is sent by its event timer", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     with<silent_by_event_timer, stopped>, Condition::state},
    {"3.12", "In Stopped no cyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_at_sync, stopped>, Condition::state},
    {"3.13", "In Stopped no acyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_at_sync_after_event, stopped>, Condition::state | Condition::stimulus},
    {"3.14", "In Stopped no TPDO is sent at its SYNC start value", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_from_sync_start_value, stopped>, Condition::state},
    {"3.15", "In Pre-operational a remote frame is not answered by a TPDO", "CiA 301, 7.3.2.2.5", with_writes,
     no_permission, with<silent_on_remote_frame, pre_operational>, Condition::state | Condition::remote_frames},
    {"3.16", "In Pre-operational no TPDO is sent for an event", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     with<silent_on_event, pre_operational>, Condition::state | Condition::stimulus},
    {"3.17", "In Pre-operational no TPDO is sent by its event timer", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     with<silent_by_event_timer, pre_operational>, Condition::state},
    {"3.18", "In Pre-operational no cyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_at_sync, pre_operational>, Condition::state},
    {"3.19", "In Pre-operational no acyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_at_sync_after_event, pre_operational>, Condition::state | Condition::stimulus},
    {"3.20", "In Pre-operational no TPDO is sent at its SYNC start value", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     with<silent_from_sync_start_value, pre_operational>, Condition::state},
};

}  // namespace

std::span<const CaseRow> tpdo_silence_cases() { return tpdo_silence_rows; }

}  // namespace edsc::conform
