/// NMT services (CiA 301, 7.2.8.2.1): each leads from each state to the correct one.
#include <fmt/format.h>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

/// Inconclusive if the device cannot report its NMT state.
void need_state(Dut& dut) {
  if (!dut.watch_state()) {
    dut.inconclusive("the EDS has neither heartbeat nor node guarding: the device does not report its NMT state");
  }
}

/// Enters a state, then another one, and expects no boot-up message in between.
void expect_transition(Dut& dut, NmtState from, NmtState to) {
  dut.enter(from);
  dut.expect_state(from);
  const Dut::Mark since = dut.mark();
  dut.enter(to);
  dut.expect_state(to);
  dut.expect(dut.received_since(since, dut.boot_up()).empty(),
             fmt::format("no boot-up message from {} to {}", to_text(from), to_text(to)), "one");
}

void resets(Dut& dut) {
  for (const NmtCommand command : {NmtCommand::reset_node, NmtCommand::reset_communication}) {
    for (const NmtState from : {NmtState::pre_operational, NmtState::operational, NmtState::stopped}) {
      dut.enter(NmtState::pre_operational);
      need_state(dut);
      dut.enter(from);
      dut.expect_state(from);
      expect_one_boot_up(dut, command);
      need_state(dut);
      expect_state_after_boot_up(dut);
    }
  }
}

/// Tests the service in each other state and in the state itself.
void service(Dut& dut, NmtState to) {
  need_state(dut);
  for (const NmtState from : {NmtState::pre_operational, NmtState::operational, NmtState::stopped, to}) {
    expect_transition(dut, from, to);
  }
}

constexpr CaseRow transition_rows[] = {
    {"10.1", "Reset node and reset communication lead from each state to a boot-up message and to Pre-operational",
     "CiA 301, 7.2.8.2.1.4, 7.2.8.2.1.5 and 7.3.2", Level::communication, Permission::none, resets,
     Condition::error_free | Condition::punctual, "9.1"},
    {"10.2", "Enter pre-operational leads from each state to Pre-operational", "CiA 301, 7.2.8.2.1.6 and 7.3.2",
     Level::communication, Permission::none, with<service, NmtState::pre_operational>,
     Condition::error_free | Condition::punctual},
    {"10.3", "Start remote node leads from each state to Operational", "CiA 301, 7.2.8.2.1.2 and 7.3.2",
     Level::communication, Permission::none, with<service, NmtState::operational>,
     Condition::error_free | Condition::punctual},
    {"10.4", "Stop remote node leads from each state to Stopped", "CiA 301, 7.2.8.2.1.3 and 7.3.2",
     Level::communication, Permission::none, with<service, NmtState::stopped>,
     Condition::error_free | Condition::punctual},
};

}  // namespace

std::span<const CaseRow> transition_cases() { return transition_rows; }

}  // namespace edsc::conform
