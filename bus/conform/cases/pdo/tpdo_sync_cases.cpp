/// TPDOs in Operational that follow SYNC (CiA 301, 7.2.2.2 and 7.5.2.37).
#include <fmt/format.h>

#include <algorithm>

#include "conform/case.hpp"
#include "conform/cases/pdo/tested_tpdos.hpp"

namespace edsc::conform {
namespace {

/// Sends one SYNC and returns whether the TPDO follows: once, and within the synchronous window if one is set.
bool is_sent_at_sync(Dut& dut, const Tpdo& tpdo, SyncSource& sync, std::uint64_t window_us) {
  const Image before = read_image(dut, tpdo.mapping);
  const std::vector<SeenFrame> frames = sync.send_and_collect(tpdo.frames());
  dut.expect(frames.size() <= 1, fmt::format("at most one {} after a SYNC", tpdo.name()), frames_text(frames), frames);
  if (frames.empty()) return false;
  expect_present_data(dut, tpdo, frames.front(), before);
  if (window_us != 0) {
    dut.expect_time(frames.front().at - sync.sent_at(), 0, window_us + wire_us,
                    fmt::format("time from SYNC to {} with the window of 1007h:00", tpdo.name()));
  }
  return true;
}

std::uint64_t window_of(Dut& dut) { return dut.is_readable(sync_window) ? dut.read_number(sync_window) : 0; }

/// Type n: at every n-th SYNC, and not without a SYNC.
void expect_each_nth(Dut& dut, const Tpdo& tpdo, SyncSource& sync, unsigned n) {
  constexpr unsigned rounds = 3;
  expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "without a SYNC");
  const std::uint64_t window_us = window_of(dut);
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

void sends_at_each_nth_sync(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  for_each_tpdo(dut, {{.type = 1}, {.type = 3}},
                [&](const Tpdo& tpdo, const Transmission& wanted) { expect_each_nth(dut, tpdo, sync, wanted.type); });
}

/// Type 0: no frame without an event. A value that changes by itself is an event.
void expect_none_without_event(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames,
                               const std::string& when) {
  if (!frames.empty() && live_bits(dut, tpdo.mapping) != 0) return;
  expect_none(dut, tpdo, frames, when);
}

void sends_at_sync_after_event(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  SyncSource sync{dut};
  std::optional<WithoutEvent> without_event;
  bool any = false;
  for_each_tpdo(dut, {{.type = acyclic}}, [&](const Tpdo& tpdo, const Transmission&) {
    (void)sync.send_and_collect(tpdo.frames());  // entering Operational may be an event
    Image before = read_image(dut, tpdo.mapping);
    for (int i = 0; i < 3; ++i) {
      const std::vector<SeenFrame> frames = sync.send_and_collect(tpdo.frames());
      const Image after = read_image(dut, tpdo.mapping);
      if (after.bits == before.bits)
        expect_none_without_event(dut, tpdo, frames, "of type 0 at a SYNC without an event before it");
      before = after;
    }
    Event event{dut, tpdo.mapping};
    bool sent = false;
    const bool found = find_event(dut, tpdo, event, [&](Dut::Mark) {
      expect_none(dut, tpdo, dut.collect(tpdo.frames(), silence), "of type 0 between an event and the next SYNC");
      return sent = is_sent_at_sync(dut, tpdo, sync, window_of(dut));
    });
    if (!found) {
      without_event = {tpdo, event.has_run()};
      return;
    }
    any = true;
    dut.expect(sent, fmt::format("{} of type 0 at the SYNC after {} has changed", tpdo.name(), event.object()),
               "no frame");
    expect_none_without_event(dut, tpdo, sync.send_and_collect(tpdo.frames()),
                              "of type 0 at the second SYNC after an event");
  });
  if (!any && without_event) no_stimulus(dut, without_event->tpdo, without_event->stimulus_has_run);
}

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
      dut.expect(is_sent_at_sync(dut, tpdo, sync, window_of(dut)),
                 fmt::format("{} at each SYNC beginning with counter {}", tpdo.name(), start.value), "no frame");
    }
  });
}

constexpr CaseRow tpdo_sync_rows[] = {
    {"3.6", "In Operational a cyclic synchronous TPDO is sent at every n-th SYNC", "CiA 301, 7.5.2.37", with_writes,
     with_sync, sends_at_each_nth_sync, Condition::state},
    {"3.7", "In Operational an acyclic synchronous TPDO is sent at the SYNC after an event", "CiA 301, 7.5.2.37",
     with_writes, with_sync, sends_at_sync_after_event, Condition::state | Condition::stimulus, "3.6"},
    {"3.8", "In Operational a synchronous TPDO waits for its SYNC start value", "CiA 301, 7.5.2.37", with_writes,
     with_sync, sends_from_sync_start_value, Condition::state, "3.6"},
};

}  // namespace

std::span<const CaseRow> tpdo_sync_cases() { return tpdo_sync_rows; }

}  // namespace edsc::conform
