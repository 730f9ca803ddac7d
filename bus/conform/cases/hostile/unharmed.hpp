/// The invariants of the hostile cases: whatever the test sends, the device responds, keeps its NMT state and its
/// values, and sends nothing that it may not send.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {

/// Conditions of all hostile cases, which begin with `need_no_other_node`.
inline constexpr Condition on_own_bus = Condition::alone;

/// The CAN-IDs of a device as its parameters say, with bit 29 for extended ones.
struct OwnCanIds {
  std::set<std::uint32_t> received;     ///< SDO requests, RPDOs, SYNC, TIME; not NMT and LSS
  std::set<std::uint32_t> rpdos;        ///< part of `received`
  std::set<std::uint32_t> transmitted;  ///< SDO responses, TPDOs, EMCY, error control
  std::set<std::uint32_t> tpdos;        ///< part of `transmitted`
};
[[nodiscard]] OwnCanIds own_can_ids(Dut& dut);

/// Enters the state, runs `attack` and checks the invariants:
///   the device keeps its NMT state, and sends no boot-up message;
///   it sends only SDO responses, EMCY, error control and, in Operational, TPDOs, SYNC and TIME;
///   it returns 1000h:00;
///   no parameter has another value: entries that PDOs map, or that changed by themselves before, are not compared.
/// The device is Pre-operational afterwards, without the errors that the attack has caused. `what` names the frames of
/// the attack in failures.
void expect_unharmed(Dut& dut, canopen::NmtState state, const std::string& what, const std::function<void()>& attack);

}  // namespace edsc::conform
