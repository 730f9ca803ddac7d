/// The communication parameters of the PDOs of the device (CiA 301, 7.5.2.35 and 7.5.2.37).
#include <fmt/format.h>

#include <canopen/pdo/pdo_parameters.hpp>
#include <map>

#include "conform/case.hpp"
#include "conform/cases/pdo/pdo_mapping.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;

struct ParameterRange {
  PdoDirection direction;
  std::uint16_t first;
  std::uint16_t count;
};
constexpr ParameterRange receive_range{PdoDirection::receive, 0x1400, classical_can.pdos};
constexpr ParameterRange transmit_range{PdoDirection::transmit, 0x1800, classical_can.pdos};

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
    const std::uint16_t index = pdo->communication->index;
    if (!dut.is_readable(index, cob_id_parameter)) continue;
    const CobId cob_id{static_cast<std::uint32_t>(dut.read_number(index, cob_id_parameter))};
    if (!cob_id.valid()) continue;
    const auto [user, is_new] = users.emplace(cob_id.value() & CobId::identifier, pdo_label(*pdo));
    if (!is_new) {
      fail_value(dut, index, cob_id_parameter, cob_id.value(), "cob-id-twice",
                 pdo_label(*pdo) + " with a CAN-ID of its own",
                 fmt::format("{:X}h, like {}", cob_id.can_id(), user->second));
    }
  }
}

/// Transmission types that CiA 301 reserves for RPDOs and TPDOs.
constexpr std::uint8_t reserved_types[] = {241, 251};

/// The first RPDO and the first TPDO with a writable transmission type refuse the reserved ones.
void refuses_reserved_types(Dut& dut) {
  bool any = false;
  dut.enter(NmtState::pre_operational);
  for (const PdoDirection direction : {PdoDirection::receive, PdoDirection::transmit}) {
    for (const Pdo* pdo : dut.pdos(direction)) {
      const std::uint16_t index = pdo->communication->index;
      if (!dut.is_writable(index, type_parameter) || !dut.is_readable(index, type_parameter)) continue;
      any = true;
      const std::uint64_t present = dut.read_number(index, type_parameter);
      for (const std::uint8_t type : reserved_types) {
        expect_refused(dut, index, type_parameter, type, present, abort_rule::value,
                       fmt::format("transmission type {} to {}", type, label(index, type_parameter)));
      }
      break;
    }
  }
  if (!any) dut.not_applicable("no PDO has a writable transmission type");
}

void scan_rpdos(Dut& dut) { scan(dut, receive_range); }

void scan_tpdos(Dut& dut) {
  scan(dut, transmit_range);
  expect_no_reserved_parameter(dut);
  expect_distinct_cob_ids(dut);
}

constexpr CaseRow pdo_parameter_rows[] = {
    {"3.1", "The device has the RPDOs of the EDS, with legal communication parameters", "CiA 301, 7.5.2.35",
     Level::read, no_permission, scan_rpdos},
    {"3.2", "The device has the TPDOs of the EDS, with legal communication parameters", "CiA 301, 7.5.2.37",
     Level::read, no_permission, scan_tpdos},
    {"3.111", "Reserved transmission types are refused", "CiA 301, 7.5.2.35 and 7.5.2.37", Level::communication,
     no_permission, refuses_reserved_types},
};

}  // namespace

std::span<const CaseRow> pdo_parameter_cases() { return pdo_parameter_rows; }

}  // namespace edsc::conform
