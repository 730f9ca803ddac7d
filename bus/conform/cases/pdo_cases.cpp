#include "conform/cases/pdo_cases.hpp"

#include <fmt/format.h>

#include <canopen/pdo/pdo_parameters.hpp>

namespace edsc::conform {
namespace pdo_area {
namespace {

using canopen::CobId;

struct ParameterRange {
  PdoDirection direction;
  std::uint16_t first;
  std::uint16_t count;
};
constexpr ParameterRange receive_range{PdoDirection::receive, 0x1400, 512};
constexpr ParameterRange transmit_range{PdoDirection::transmit, 0x1800, 512};

/// A valid PDO must have a CAN-ID that CiA 301, 7.3.5 does not restrict.
void expect_legal_cob_id(Dut& dut, std::uint16_t index, std::uint32_t cob_id) {
  const CobId parsed{cob_id};
  if (!parsed.valid() || canopen::may_be_written(parsed, true, true)) return;
  fail_value(dut, index, cob_id_parameter, cob_id, "cob-id-restricted",
             label(index, cob_id_parameter) + " with a CAN-ID that CiA 301 does not restrict",
             fmt::format("{:08X}h", cob_id));
}

void expect_legal_type(Dut& dut, const ParameterRange& range, std::uint16_t index, std::uint64_t type) {
  const bool receives = range.direction == PdoDirection::receive;
  if (canopen::transmission_type_is_legal(receives, static_cast<std::uint32_t>(type))) return;
  fail_value(dut, index, type_parameter, type, "pdo-transmission-type",
             label(index, type_parameter) + " with a transmission type that is not reserved", fmt::format("{}", type));
}

/// 1400h or 1800h of the EDS: all its parameters can be read and have legal values.
void expect_communication_parameter(Dut& dut, const ParameterRange& range, const Object& object) {
  for (const Entry& entry : object.entries) {
    if (!canopen::readable(entry.access)) continue;
    const std::uint64_t value = dut.read_number(entry.index, entry.sub_index);
    const std::string name = label(entry.index, entry.sub_index);
    if (entry.sub_index == 0) {
      dut.expect(value >= type_parameter, name + " of 2 or more: COB-ID and transmission type are mandatory",
                 fmt::format("{}", value));
    } else if (entry.sub_index == cob_id_parameter) {
      expect_legal_cob_id(dut, entry.index, static_cast<std::uint32_t>(value));
    } else if (entry.sub_index == type_parameter) {
      expect_legal_type(dut, range, entry.index, value);
    }
  }
}

/// The device does not have a PDO that the EDS does not have.
void expect_no_pdo(Dut& dut, std::uint16_t index, canopen::AbortCode& known) {
  const SdoOutcome outcome = dut.upload(index, cob_id_parameter);
  if (outcome.end == SdoEnd::refused && outcome.code == known) return;
  dut.expect_abort(outcome, abort_rule::no_object, label(index, cob_id_parameter) + ", which the EDS does not have");
  known = outcome.code;
}

void scan(Dut& dut, const ParameterRange& range) {
  canopen::AbortCode known = canopen::ok;
  for (std::uint16_t i = 0; i < range.count; ++i) {
    const auto index = static_cast<std::uint16_t>(range.first + i);
    if (const Object* object = dut.sheet().find(index)) {
      expect_communication_parameter(dut, range, *object);
    } else {
      expect_no_pdo(dut, index, known);
    }
  }
}

/// Sub-index 4 does not exist, unless the EDS has it.
void expect_no_reserved_parameter(Dut& dut) {
  std::string reserved;
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) {
    const std::uint16_t index = pdo->communication->index;
    const std::string name = label(index, reserved_parameter);
    if (dut.has(index, reserved_parameter)) {
      reserved += reserved.empty() ? name : ", " + name;
    } else {
      dut.expect_abort(dut.upload(index, reserved_parameter), abort_rule::no_sub_index, name);
    }
  }
  if (!reserved.empty()) dut.warn("the EDS has an entry that CiA 301 reserves: " + reserved);
}

/// No two TPDOs have the same CAN-ID.
void expect_distinct_cob_ids(Dut& dut) {
  std::map<std::uint32_t, std::string> users;
  for (const Pdo* pdo : dut.pdos(PdoDirection::transmit)) {
    const Entry* const entry = dut.entry(pdo->communication->index, cob_id_parameter);
    if (entry == nullptr || !canopen::readable(entry->access)) continue;
    const CobId cob_id{static_cast<std::uint32_t>(dut.read_number(entry->index, cob_id_parameter))};
    if (!cob_id.valid()) continue;
    const auto [user, is_new] = users.emplace(cob_id.value() & CobId::identifier, pdo_label(*pdo));
    if (!is_new) {
      fail_value(dut, entry->index, cob_id_parameter, cob_id.value(), "cob-id-twice",
                 pdo_label(*pdo) + " with a CAN-ID of its own",
                 fmt::format("{:X}h, like {}", cob_id.can_id(), user->second));
    }
  }
}

void scan_rpdos(Dut& dut) { scan(dut, receive_range); }

void scan_tpdos(Dut& dut) {
  scan(dut, transmit_range);
  expect_no_reserved_parameter(dut);
  expect_distinct_cob_ids(dut);
}

using StateCase = void (*)(Dut&, NmtState);
template <StateCase run>
void stopped(Dut& dut) {
  run(dut, NmtState::stopped);
}
template <StateCase run>
void pre_operational(Dut& dut) {
  run(dut, NmtState::pre_operational);
}

constexpr Level with_writes = Level::communication;
constexpr Permission no_permission = Permission::none, with_sync = Permission::outputs;

// Cases 3.3 to 3.8 run in Operational, 3.9 to 3.14 in Stopped, and 3.15 to 3.20 in Pre-operational: table 37 allows
// PDOs in Operational only. Cases that send SYNC need the permission for outputs, because devices apply received data
// at a SYNC.
constexpr CaseRow rows[] = {
    {"3.1", "The device has the RPDOs of the EDS, with legal communication parameters", "CiA 301, 7.5.2.35",
     Level::read, no_permission, scan_rpdos},
    {"3.2", "The device has the TPDOs of the EDS, with legal communication parameters", "CiA 301, 7.5.2.37",
     Level::read, no_permission, scan_tpdos},
    {"3.3", "In Operational a remote frame is answered by its TPDO", "CiA 301, 7.2.2.3", with_writes, no_permission,
     sends_on_remote_frame},
    {"3.4", "In Operational a TPDO is sent once for each event, but not within its inhibit time", "CiA 301, 7.5.2.37",
     with_writes, no_permission, sends_on_event},
    {"3.5", "In Operational a TPDO is sent when its event timer elapses", "CiA 301, 7.5.2.37", with_writes,
     no_permission, sends_by_event_timer},
    {"3.6", "In Operational a cyclic synchronous TPDO is sent at every n-th SYNC", "CiA 301, 7.5.2.37", with_writes,
     with_sync, sends_at_each_nth_sync},
    {"3.7", "In Operational an acyclic synchronous TPDO is sent at the SYNC after an event", "CiA 301, 7.5.2.37",
     with_writes, with_sync, sends_at_sync_after_event},
    {"3.8", "In Operational a synchronous TPDO waits for its SYNC start value", "CiA 301, 7.5.2.37", with_writes,
     with_sync, sends_from_sync_start_value},
    {"3.9", "In Stopped a remote frame is not answered by a TPDO", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     stopped<silent_on_remote_frame>},
    {"3.10", "In Stopped no TPDO is sent for an event", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     stopped<silent_on_event>},
    {"3.11", "In Stopped no TPDO is sent by its event timer", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     stopped<silent_by_event_timer>},
    {"3.12", "In Stopped no cyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     stopped<silent_at_sync>},
    {"3.13", "In Stopped no acyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     stopped<silent_at_sync_after_event>},
    {"3.14", "In Stopped no TPDO is sent at its SYNC start value", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     stopped<silent_from_sync_start_value>},
    {"3.15", "In Pre-operational a remote frame is not answered by a TPDO", "CiA 301, 7.3.2.2.5", with_writes,
     no_permission, pre_operational<silent_on_remote_frame>},
    {"3.16", "In Pre-operational no TPDO is sent for an event", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     pre_operational<silent_on_event>},
    {"3.17", "In Pre-operational no TPDO is sent by its event timer", "CiA 301, 7.3.2.2.5", with_writes, no_permission,
     pre_operational<silent_by_event_timer>},
    {"3.18", "In Pre-operational no cyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     pre_operational<silent_at_sync>},
    {"3.19", "In Pre-operational no acyclic synchronous TPDO is sent", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     pre_operational<silent_at_sync_after_event>},
    {"3.20", "In Pre-operational no TPDO is sent at its SYNC start value", "CiA 301, 7.3.2.2.5", with_writes, with_sync,
     pre_operational<silent_from_sync_start_value>},
    {"3.21", "Each object that a PDO maps exists and may be mapped", "CiA 301, 7.5.2.36", Level::read, no_permission,
     mapping_fits_dictionary},
    {"3.22", "A new mapping by the procedure of CiA 301 is accepted and used", "CiA 301, 7.5.2.36", with_writes,
     with_sync, takes_new_mapping},
    {"3.23", "A mapping entry is not changed while the PDO is valid and maps objects", "CiA 301, 7.5.2.36", with_writes,
     no_permission, refuses_entry_of_active_mapping},
    {"3.24", "A mapping is not changed while the PDO is valid", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_mapping_of_valid_pdo},
    {"3.25", "More objects than the mapping parameter has entries are refused", "CiA 301, 7.5.2.36", with_writes,
     no_permission, refuses_too_many_objects},
    {"3.26", "A mapping of more than 64 bits is refused", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_too_many_bits},
    {"3.27", "An RPDO can map an object that is rww or wo", "CiA 301, 7.5.2.36", with_writes, no_permission,
     takes_output_in_rpdo},
    {"3.28", "An RPDO does not map an object that is rwr or ro", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_input_in_rpdo},
    {"3.29", "An RPDO does not map an object with PDOMapping=0", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_unmappable_in_rpdo},
    {"3.30", "A TPDO can map an object that is rwr or ro", "CiA 301, 7.5.2.38", with_writes, no_permission,
     takes_input_in_tpdo},
    {"3.31", "A TPDO does not map an object that is rww or wo", "CiA 301, 7.5.2.38", with_writes, no_permission,
     refuses_output_in_tpdo},
    {"3.32", "A TPDO does not map an object with PDOMapping=0", "CiA 301, 7.5.2.38", with_writes, no_permission,
     refuses_unmappable_in_tpdo},
    {"3.33", "An RPDO can map a dummy object", "CiA 301, 7.4.7.1", with_writes, no_permission, takes_dummy_in_rpdo},
};

}  // namespace
}  // namespace pdo_area

std::span<const CaseRow> pdo_cases() { return pdo_area::rows; }

}  // namespace edsc::conform
