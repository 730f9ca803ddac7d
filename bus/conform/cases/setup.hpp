/// What cases of several areas set up or look for before they ask their question.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "conform/dut.hpp"
#include "online/interruption.hpp"

namespace edsc::conform {

/// Does what undoes a step of a case, however the case ends: at an interruption as well.
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

/// The COB-ID that an object has by default: that of the data sheet, else the standard one. Another one fails where it
/// is a restricted one or cannot be written; else somebody may have configured it, and the case is inconclusive.
void expect_default_cob_id(Dut& dut, std::uint16_t index, std::uint32_t standard);

/// 1014h:00. Not applicable where the data sheet does not have it, or where it says that EMCY is not valid.
[[nodiscard]] std::uint32_t emcy_cob_id(Dut& dut);
/// The EMCYs of the device with this emergency error code.
[[nodiscard]] Dut::Match emcy_with_code(std::uint32_t cob_id, std::uint16_t code);
[[nodiscard]] std::uint16_t emergency_code_of(const canopen::Frame& frame);

/// Listens for this time, and says whether another node has sent a boot-up message, a heartbeat or an SDO answer.
[[nodiscard]] bool hears_other_nodes(Dut& dut, Duration span);
/// A node-ID that was not heard while listening, and that 1016h of the device does not name.
[[nodiscard]] canopen::NodeId free_node_id(Dut& dut);

/// A parameter of 1000h to 1FFFh that cases may change: nothing is sent because of it, and "save" stores it.
struct Parameter {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;

  [[nodiscard]] std::string name() const { return label(index, sub_index); }
};
[[nodiscard]] std::optional<Parameter> harmless_parameter(const Dut& dut);
/// A value that the parameter does not have now, and not by default.
[[nodiscard]] std::uint64_t other_value(Dut& dut, const Parameter& parameter);

/// Makes a TPDO send as this transmission type says; 0 ms: without event timer. Its COB-ID; nothing where no TPDO of
/// the data sheet can do so.
[[nodiscard]] std::optional<std::uint32_t> set_up_tpdo(Dut& dut, std::uint8_t transmission_type,
                                                       std::uint16_t event_timer_ms);

/// Stops the SYNC producer of the device: 1006h is 0 and bit 30 of 1005h is 0. The CAN-ID of SYNC with bit 29. Not
/// applicable where the data sheet does not have 1005h.
std::uint32_t stop_sync(Dut& dut);
/// Whether the device can produce SYNC: 1005h and 1006h can be written, and bit 30 is not refused. `stop_sync` comes
/// before.
[[nodiscard]] bool can_produce_sync(Dut& dut, std::uint32_t cob_id);
/// Begins to produce SYNC. `stop_sync` and `can_produce_sync` come before.
void start_sync(Dut& dut, std::uint32_t cob_id, Duration period);

/// Resets the device and fails where it does not send exactly one boot-up message.
void expect_one_boot_up(Dut& dut, canopen::NmtCommand command);
/// Fails where a device that says its state is not Pre-operational after its boot-up message. Operational is as good
/// where 1F80h lets it start by itself.
void expect_state_after_boot_up(Dut& dut);

}  // namespace edsc::conform
