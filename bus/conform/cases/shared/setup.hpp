/// Preconditions that cases of several areas have in common.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "conform/dut/dut.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {

/// Runs a step of a case, then undoes it, also if the case ends early or is interrupted.
template <class Check, class Undo>
void and_undo(Check check, Undo undo) {
  try {
    check();
  } catch (const CaseEnd&) {
    undo();
    throw;
  } catch (const Interrupted&) {
    const Uninterrupted uninterrupted;
    undo();
    throw;
  }
  undo();
}

/// Writes a value that the device must refuse, and expects that the entry still has its value.
void expect_refused(Dut& dut, std::uint16_t index, std::uint8_t sub_index, std::uint64_t value, std::uint64_t present,
                    const AbortRule& rule, const std::string& what);

/// Expects the default COB-ID of an object: that of the EDS, else the standard one. Another COB-ID fails if its CAN-ID
/// is restricted or if it cannot be written. Otherwise it may have been configured, and the case is inconclusive.
void expect_default_cob_id(Dut& dut, std::uint16_t index, std::uint32_t standard);

/// Returns 1014h:00. Not applicable if the EDS does not have it, or if EMCY is not valid.
[[nodiscard]] std::uint32_t emcy_cob_id(Dut& dut);
/// Matches EMCYs of the device with this emergency error code.
[[nodiscard]] Dut::Match emcy_with_code(std::uint32_t cob_id, std::uint16_t code);
[[nodiscard]] std::uint16_t emergency_code_of(const canopen::Frame& frame);

/// Listens for `span` and returns whether another node sent a boot-up message, a heartbeat or an SDO answer.
[[nodiscard]] bool hears_other_nodes(Dut& dut, Duration span);
/// Inconclusive if another node is on the bus, which the frames of the case could disturb. Does not listen in simulated
/// time.
void need_no_other_node(Dut& dut);
/// Listens and returns a node-ID that neither a CAN-ID on the bus nor 1016h of the device includes.
[[nodiscard]] canopen::NodeId free_node_id(Dut& dut);

/// A parameter of 1000h to 1FFFh that cases may change: it has no effect on other nodes, and "save" stores it.
struct Parameter {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;

  [[nodiscard]] std::string name() const { return label(index, sub_index); }
};
[[nodiscard]] std::optional<Parameter> harmless_parameter(const Dut& dut);
/// Returns a value that is neither the present nor the default value of the parameter.
[[nodiscard]] std::uint64_t other_value(Dut& dut, const Parameter& parameter);

/// Configures a TPDO with this transmission type; 0 ms: without event timer. Returns its COB-ID; std::nullopt if no
/// TPDO of the EDS supports it.
[[nodiscard]] std::optional<std::uint32_t> set_up_tpdo(Dut& dut, std::uint8_t transmission_type,
                                                       std::uint16_t event_timer_ms);

/// Stops the SYNC producer of the device: sets 1006h and bit 30 of 1005h to 0. Returns the CAN-ID of SYNC with bit 29.
/// Not applicable if the EDS does not have 1005h.
std::uint32_t stop_sync(Dut& dut);
/// Whether the device can produce SYNC: 1005h and 1006h are writable, and bit 30 is accepted. Call `stop_sync` before.
[[nodiscard]] bool can_produce_sync(Dut& dut, std::uint32_t cob_id);
/// Starts the SYNC producer. Call `stop_sync` and `can_produce_sync` before.
void start_sync(Dut& dut, std::uint32_t cob_id, Duration period);

/// Ends the errors of the device by reset communication. Does not fail: other cases test the boot-up message.
void end_errors(Dut& dut);

/// Resets the device and fails unless it sends exactly one boot-up message.
void expect_one_boot_up(Dut& dut, canopen::NmtCommand command);
/// Fails if the device is not Pre-operational after its boot-up message. Operational is also accepted: with a warning,
/// unless 1F80h demands it, because a device may start by local control. Call `watch_state` before.
void expect_state_after_boot_up(Dut& dut);

}  // namespace edsc::conform
