/// The TPDOs that a case tests, one after the other, and what it expects of their frames.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <string>
#include <vector>

#include "conform/cases/pdo/tpdo.hpp"
#include "conform/cases/pdo/tpdo_triggers.hpp"

namespace edsc::conform {

/// The delay of a TPDO by other frames on the bus.
inline constexpr std::uint32_t wire_us = 1'000;

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
      restore(dut, tpdo);
    }
  }
  tested.need_one();
}

void expect_none(Dut& dut, const Tpdo& tpdo, const std::vector<SeenFrame>& frames, const std::string& when);
SeenFrame expect_frame(Dut& dut, const Tpdo& tpdo, Dut::Mark since, Duration longest, const std::string& when);
/// Whether the values of the TPDO change by themselves, so that its events cannot be counted. Fails for a TPDO without
/// a change, because it is sent without an event.
bool changes_by_itself(Dut& dut, const Tpdo& tpdo);

/// Inconclusive: no stimulus changes an object of the TPDO. `has_run`: a stimulus succeeded, and no object changed.
[[noreturn]] void no_stimulus(Dut& dut, const Tpdo& tpdo, bool has_run);
/// A TPDO without an event.
struct WithoutEvent {
  Tpdo tpdo;
  bool stimulus_has_run = false;
};
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

/// An event timer that the EDS allows, in ms.
[[nodiscard]] std::uint16_t timer_of(const Dut& dut, const Tpdo& tpdo);

}  // namespace edsc::conform
