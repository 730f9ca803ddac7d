/// NMT states (CiA 301, 7.3.2.2): the services that are active, and those that are not, in each state.
#include <fmt/format.h>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::uint16_t test_error = 0x1000;
constexpr std::uint8_t test_bit = 0x01;
constexpr Duration cycle = milliseconds{50};
constexpr unsigned cycles = 6;

/// Services with which the device sends by itself, if it supports them.
struct Services {
  std::optional<std::uint32_t> tpdo;  ///< COB-ID of a TPDO that is sent every cycle
  std::optional<std::uint32_t> sync;  ///< COB-ID, produced every cycle
  std::optional<std::uint32_t> emcy;
  bool state = false;  ///< the device reports its NMT state
};

/// Starts the services, in Pre-operational.
Services start_services(Dut& dut) {
  Services services;
  constexpr std::uint8_t event_driven = 255;
  services.tpdo = set_up_tpdo(dut, event_driven, static_cast<std::uint16_t>(cycle.count() / 1000));
  if (dut.has(sync_cob_id) && dut.allowed(Permission::outputs)) {
    const std::uint32_t cob_id = stop_sync(dut);
    if (can_produce_sync(dut, cob_id)) {
      start_sync(dut, cob_id, cycle);
      services.sync = cob_id;
    }
  }
  if (dut.has(emcy) && canopen::CobId{static_cast<std::uint32_t>(dut.read_number(emcy))}.valid()) {
    services.emcy = emcy_cob_id(dut);
  }
  services.state = dut.watch_state();
  return services;
}

void expect_runs(Dut& dut, bool runs, std::size_t frames, const std::string& what) {
  if (runs) {
    dut.expect(frames + 2 >= cycles, fmt::format("{}: about {} in {} ms", what, cycles, cycle.count() * cycles / 1000),
               std::to_string(frames));
  } else {
    dut.expect(frames == 0, "no " + what, std::to_string(frames));
  }
}

/// Table 39 of CiA 301: PDO in Operational only; SDO, SYNC and EMCY in Pre-operational and Operational; error control
/// in all three.
void expect_services(Dut& dut, const Services& services, NmtState state) {
  const std::string in = fmt::format(" in {}", to_text(state));
  if (services.state) dut.expect_state(state);
  const Dut::Mark since = dut.mark();
  dut.pass_time(cycle * cycles);
  const auto sent = [&](std::uint32_t cob_id) { return dut.received_since(since, Dut::with_cob_id(cob_id)).size(); };
  if (services.tpdo)
    expect_runs(dut, canopen::serves_pdo(state), sent(*services.tpdo), "TPDOs with an event timer of 50 ms" + in);
  if (services.sync)
    expect_runs(dut, canopen::serves_sync(state), sent(*services.sync), "SYNCs with a period of 50 ms" + in);

  const SdoOutcome outcome = dut.upload(device_type);
  if (canopen::serves_sdo(state)) {
    dut.expect(outcome.done() || outcome.end == SdoEnd::refused, "an answer to an SDO request" + in,
               outcome_text(outcome));
  } else {
    dut.expect(outcome.end == SdoEnd::no_answer, "no answer to an SDO request" + in, outcome_text(outcome));
  }
  if (services.emcy && dut.stimuli().emergency(test_error, test_bit)) {
    dut.pass_time(cycle);
    const std::size_t messages = sent(*services.emcy);
    (void)dut.stimuli().emergency_over(test_bit);
    dut.expect((messages != 0) == canopen::serves_emcy(state),
               (canopen::serves_emcy(state) ? "an EMCY" : "no EMCY") + in, std::to_string(messages));
  }
}

/// A reset restores the value that a parameter had after the reset before: the default value or the stored one.
void boot_up(Dut& dut) {
  for (const NmtCommand command : {NmtCommand::reset_node, NmtCommand::reset_communication}) {
    expect_one_boot_up(dut, command);
    const std::optional<Parameter> parameter = harmless_parameter(dut);
    if (!parameter) continue;
    const std::uint64_t before = dut.read_number(parameter->index, parameter->sub_index);
    dut.write(parameter->index, parameter->sub_index, other_value(dut, *parameter));
    dut.reset(command);
    dut.expect_equal(dut.read_number(parameter->index, parameter->sub_index), before,
                     parameter->name() + " after a reset, as after the first reset");
  }
}

void pre_operational(Dut& dut) {
  expect_one_boot_up(dut, NmtCommand::reset_node);
  if (dut.watch_state()) expect_state_after_boot_up(dut);
  dut.enter(NmtState::pre_operational);
  expect_services(dut, start_services(dut), NmtState::pre_operational);
}

void operational(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  const Services services = start_services(dut);
  dut.enter(NmtState::operational);
  expect_services(dut, services, NmtState::operational);
}

void stopped(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  const Services services = start_services(dut);
  dut.enter(NmtState::operational);
  dut.enter(NmtState::stopped);
  expect_services(dut, services, NmtState::stopped);
  dut.enter(NmtState::pre_operational);
  expect_services(dut, services, NmtState::pre_operational);
}

constexpr CaseRow state_rows[] = {
    {"9.1", "After a reset the device sends one boot-up message and has its power-on values",
     "CiA 301, 7.2.8.3.3 and 7.3.2.2.1", Level::communication, Permission::none, boot_up},
    {"9.2", "After its boot-up message the device is Pre-operational: SDO, SYNC, EMCY and error control, but no PDO",
     "CiA 301, 7.3.2.2.2 and 7.3.2.2.5", Level::communication, Permission::none, pre_operational,
     Condition::error_free | Condition::punctual, "9.1"},
    {"9.3", "In Operational all services are active", "CiA 301, 7.3.2.2.3 and 7.3.2.2.5", Level::communication,
     Permission::none, operational, Condition::error_free | Condition::punctual},
    {"9.4", "In Stopped only NMT and error control are active", "CiA 301, 7.3.2.2.4 and 7.3.2.2.5",
     Level::communication, Permission::none, stopped, Condition::error_free | Condition::punctual},
};

}  // namespace

std::span<const CaseRow> state_cases() { return state_rows; }

}  // namespace edsc::conform
