/// RPDOs: the states in which they are processed (CiA 301, 7.3.2.2.5), and their length (7.2.2.5.1).
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>

#include "conform/case.hpp"
#include "conform/cases/pdo/tested_rpdo.hpp"
#include "conform/cases/pdo/tpdo.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;
using Applied = TestedRpdo::Applied;

constexpr Permission with_outputs = Permission::outputs;
constexpr std::uint16_t length_exceeded = 0x8220;

/// A value that is written to a parameter of a valid PDO: refused because of the state, or as an invalid value.
constexpr AbortRule in_use{
    {canopen::AbortCode::invalid_value, canopen::AbortCode::device_state, canopen::AbortCode::unsupported_access},
    {canopen::AbortCode::parameter_incompatible, canopen::AbortCode::read_only, canopen::AbortCode::general}};

/// The time that a device may need to send an EMCY.
constexpr Duration to_report = milliseconds{1000};

/// Runs a check with an RPDO. At the end the device processes an RPDO with the values that the objects had at first.
template <class Check>
void with_rpdo(Dut& dut, Check check) {
  dut.enter(NmtState::pre_operational);
  TestedRpdo rpdo{dut};
  and_undo([&] { check(rpdo); },
           [&] {
             if (rpdo.applied() == Applied::none) return;
             dut.enter(NmtState::operational);
             rpdo.send_present();
             dut.enter(NmtState::pre_operational);
           });
}

/// Proves that the RPDO would have changed the objects: in Operational it does.
void expect_processed(Dut& dut, TestedRpdo& rpdo, const std::string& when) {
  dut.enter(NmtState::operational);
  rpdo.send();
  dut.expect(rpdo.applied() != Applied::none, fmt::format("{} is processed {}", rpdo.name(), when),
             "its objects are unchanged");
}

/// An RPDO of the right length is processed now; the objects have their former values afterwards.
void need_processed(Dut& dut, TestedRpdo& rpdo) {
  rpdo.send();
  if (rpdo.applied() == Applied::none) {
    dut.inconclusive(Condition::state, rpdo.name() + " is not processed in Operational; case 3.101 tests that it is");
  }
  rpdo.send_present();
}

void ignored_in(Dut& dut, NmtState state) {
  with_rpdo(dut, [&dut, state](TestedRpdo& rpdo) {
    if (state != NmtState::pre_operational) dut.enter(state);
    rpdo.send();
    if (state == NmtState::stopped) dut.enter(NmtState::pre_operational);
    rpdo.expect_ignored(fmt::format("in {}", to_text(state)));
    expect_processed(dut, rpdo, "in Operational");
  });
}

/// An RPDO that is received in Pre-operational is not processed later either: not by Start, and not at the next SYNC.
void not_kept(Dut& dut) {
  with_rpdo(dut, [&dut](TestedRpdo& rpdo) {
    rpdo.send();
    dut.enter(NmtState::operational);
    rpdo.send_sync();
    dut.pass_time(milliseconds{50});
    rpdo.expect_ignored("in Operational if it was received in Pre-operational");
  });
}

/// A shorter RPDO is not processed, and the device reports it.
void too_short(Dut& dut) {
  with_rpdo(dut, [&dut](TestedRpdo& rpdo) {
    const bool reports = dut.has(emcy) && CobId{static_cast<std::uint32_t>(dut.read_number(emcy))}.valid();
    const std::uint32_t emcy_id = reports ? emcy_cob_id(dut) : 0;
    dut.enter(NmtState::operational);
    need_processed(dut, rpdo);
    and_undo(
        [&] {
          const Dut::Mark since = dut.mark();
          rpdo.send(rpdo.size() - 1);
          rpdo.expect_ignored(fmt::format("with {} of its {} bytes", rpdo.size() - 1, rpdo.size()));
          if (!reports) return;
          const auto event = emcy_with_code(emcy_id, canopen::emergency_code::pdo_length);
          dut.expect(dut.wait_for(event, to_report, since).has_value(), "an EMCY with code 8210h for a short RPDO",
                     "none");
        },
        [&] {
          // The error ends with an RPDO of the right length, in some devices only with a reset.
          rpdo.send_present();
          end_errors(dut);
        });
  });
}

/// Of a longer RPDO a device either uses the first bytes, or does not process it and sends 8220h.
void too_long(Dut& dut) {
  with_rpdo(dut, [&dut](TestedRpdo& rpdo) {
    if (rpdo.size() >= 8) dut.not_applicable(rpdo.name() + " maps 8 bytes");
    const bool reports = dut.has(emcy) && CobId{static_cast<std::uint32_t>(dut.read_number(emcy))}.valid();
    const std::uint32_t emcy_id = reports ? emcy_cob_id(dut) : 0;
    dut.enter(NmtState::operational);
    const Dut::Mark since = dut.mark();
    rpdo.send(rpdo.size() + 1);
    const Applied applied = rpdo.applied();
    dut.expect(applied != Applied::some, "all objects of a longer RPDO have its values, or none", "some have");
    if (applied == Applied::all || !reports) return;
    const bool reported = dut.wait_for(emcy_with_code(emcy_id, length_exceeded), milliseconds{100}, since).has_value();
    if (!reported) dut.warn("an RPDO that is too long is not processed, without an EMCY with code 8220h");
  });
}

/// Bit 31 of 1400h:01 disables the RPDO.
void disabled(Dut& dut) {
  with_rpdo(dut, [&dut](TestedRpdo& rpdo) {
    dut.need_writable(rpdo.index(), cob_id_parameter);
    dut.write(rpdo.index(), cob_id_parameter, rpdo.cob_id() | CobId::invalid_bit);
    dut.enter(NmtState::operational);
    rpdo.send();
    rpdo.expect_ignored("while bit 31 of its COB-ID is 1");
    dut.write(rpdo.index(), cob_id_parameter, rpdo.cob_id());
    expect_processed(dut, rpdo, "after bit 31 of its COB-ID is 0");
  });
}

/// A synchronous RPDO is processed at the next SYNC.
void at_sync(Dut& dut) {
  with_rpdo(dut, [&dut](TestedRpdo& rpdo) {
    (void)stop_sync(dut);
    if (!rpdo.end_sync_window())
      dut.not_applicable("1007h:00 limits the time after a SYNC in which an RPDO is received");
    dut.need_writable(rpdo.index(), type_parameter);
    constexpr std::uint64_t each_sync = 1;
    const SdoOutcome outcome = dut.download(rpdo.index(), type_parameter, each_sync);
    if (!outcome.done()) {
      dut.expect_abort(outcome, abort_rule::value, "transmission type 1 to " + label(rpdo.index(), type_parameter));
      dut.not_applicable(rpdo.name() + " does not support transmission type 1");
    }
    dut.enter(NmtState::operational);
    rpdo.send_frame(rpdo.size());
    dut.pass_time(milliseconds{50});
    if (rpdo.applied() != Applied::none) {
      dut.warn(rpdo.name() + " of type 1 changes its objects before the SYNC");
    }
    rpdo.send_sync();
    dut.pass_time(milliseconds{50});
    dut.expect(rpdo.applied() != Applied::none, rpdo.name() + " of type 1 is processed at the SYNC",
               "its objects are unchanged");
  });
}

/// Bits 0 to 29 of a COB-ID do not change while the PDO is valid.
void fixed_while_valid(Dut& dut, PdoDirection direction) {
  dut.enter(NmtState::pre_operational);
  for (const Pdo* pdo : dut.pdos(direction)) {
    const std::uint16_t index = pdo->communication->index;
    if (!dut.is_writable(index, cob_id_parameter)) continue;
    const auto present = static_cast<std::uint32_t>(dut.read_number(index, cob_id_parameter));
    if (!canopen::is_usable(present & ~CobId::no_rtr_bit)) continue;
    constexpr std::uint32_t unused = 0x6A0, other_unused = 0x6A1;  // not in the pre-defined connection set
    const std::uint32_t can_id = CobId{present}.can_id() == unused ? other_unused : unused;
    return expect_refused(dut, index, cob_id_parameter, (present & CobId::no_rtr_bit) | can_id, present, in_use,
                          fmt::format("another CAN-ID to {} while the PDO is valid", label(index, cob_id_parameter)));
  }
  dut.not_applicable("no valid PDO has a writable COB-ID");
}

/// The inhibit time does not change while the TPDO is valid.
void inhibit_time_fixed_while_valid(Dut& dut) {
  dut.enter(NmtState::pre_operational);
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) {
    const std::uint16_t index = pdo->communication->index;
    // If its COB-ID cannot be written, the TPDO is always valid: an EDS with a writable inhibit time means that it
    // changes.
    if (!dut.is_writable(index, inhibit_parameter) || !dut.is_writable(index, cob_id_parameter)) continue;
    const auto cob_id = static_cast<std::uint32_t>(dut.read_number(index, cob_id_parameter));
    if (!canopen::is_usable(cob_id & ~CobId::no_rtr_bit)) continue;
    const std::uint64_t present = dut.read_number(index, inhibit_parameter);
    const std::uint64_t other = within_limits(dut, index, inhibit_parameter, present == 200 ? 300 : 200);
    if (other == present) continue;
    return expect_refused(
        dut, index, inhibit_parameter, other, present, in_use,
        fmt::format("another inhibit time to {} while the PDO is valid", label(index, inhibit_parameter)));
  }
  dut.not_applicable("no valid TPDO has a writable COB-ID and a writable inhibit time");
}

constexpr CaseRow rpdo_rows[] = {
    {"3.101", "In Pre-operational an RPDO is not processed", "CiA 301, 7.3.2.2.5", with_writes, with_outputs,
     with<ignored_in, NmtState::pre_operational>, Condition::state | Condition::usable_value},
    {"3.102", "In Stopped an RPDO is not processed", "CiA 301, 7.3.2.2.5", with_writes, with_outputs,
     with<ignored_in, NmtState::stopped>, Condition::state | Condition::usable_value},
    {"3.103", "An RPDO that is received in Pre-operational is not processed in Operational", "CiA 301, 7.3.2.2.5",
     with_writes, with_outputs, not_kept, Condition::state | Condition::usable_value, "3.101"},
    {"3.104", "An RPDO that is shorter than its mapping is not processed and is reported with 8210h",
     "CiA 301, 7.2.2.5.1 and 7.2.7.1", with_writes, with_outputs, too_short,
     Condition::state | Condition::usable_value},
    {"3.105", "Of an RPDO that is longer than its mapping the first bytes are used, or it is not processed",
     "CiA 301, 7.2.2.5.1 and 7.2.7.1", with_writes, with_outputs, too_long, Condition::state | Condition::usable_value},
    {"3.106", "An RPDO whose COB-ID is not valid is not processed", "CiA 301, 7.5.2.35", with_writes, with_outputs,
     disabled, Condition::state | Condition::usable_value},
    {"3.107", "A synchronous RPDO is processed at the next SYNC", "CiA 301, 7.2.2.2", with_writes, with_outputs,
     at_sync, Condition::state | Condition::usable_value},
    {"3.108", "The CAN-ID of an RPDO does not change while the RPDO is valid", "CiA 301, 7.5.2.35", with_writes,
     no_permission, with<fixed_while_valid, PdoDirection::receive>},
    {"3.109", "The CAN-ID of a TPDO does not change while the TPDO is valid", "CiA 301, 7.5.2.37", with_writes,
     no_permission, with<fixed_while_valid, PdoDirection::transmit>},
    {"3.110", "The inhibit time of a TPDO does not change while the TPDO is valid", "CiA 301, 7.5.2.37", with_writes,
     no_permission, inhibit_time_fixed_while_valid},
};

}  // namespace

std::span<const CaseRow> rpdo_cases() { return rpdo_rows; }

}  // namespace edsc::conform
