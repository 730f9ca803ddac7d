/// Faults of a node of a plant.
#pragma once

#include <cstdint>
#include <string_view>

#include "canopen/emcy/emcy_consumer.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"

namespace canopen {

enum class PlantFaultKind : std::uint8_t {
  boot,              ///< its boot-up failed: `boot`. After no_response it is tried again every second; after a fault
                     ///< of the supervised boot-up (`is_disturbed`) it is reset and booted again, twice in a row
  lost,              ///< no heartbeat or guarding response within its time; it is reset, and booted when it is back
  not_watched,       ///< it has booted, but its loss will not be detected: neither heartbeat nor guarding
  unexpected_state,  ///< a state other than the one commanded: `state`
  toggle_error,      ///< guarding: a response with the same toggle bit as the previous one
  emergency,         ///< an EMCY with a code other than 0000h: `emergency`
  emergency_over,    ///< EMCY 0000h: an error has disappeared, the error register has the remaining ones
  pdo_missing,       ///< a TPDO of the node was not received within the event timer of RPDO `rpdo` of the master
  pdo_too_short,     ///< a TPDO of the node has fewer bytes than RPDO `rpdo` of the master
  restarted,         ///< a boot-up message without a reset by the master, or of a second node with its node-ID
};

[[nodiscard]] constexpr std::string_view to_text(PlantFaultKind kind) {
  switch (kind) {
    case PlantFaultKind::boot: return "boot-up failed";
    case PlantFaultKind::lost: return "lost";
    case PlantFaultKind::not_watched: return "not watched: neither heartbeat nor guarding is configured";
    case PlantFaultKind::unexpected_state: return "NMT state is not the commanded one";
    case PlantFaultKind::toggle_error: return "toggle bit of node guarding did not alternate";
    case PlantFaultKind::emergency: return "EMCY";
    case PlantFaultKind::emergency_over: return "error has disappeared";
    case PlantFaultKind::pdo_missing: return "PDO was not received in time";
    case PlantFaultKind::pdo_too_short: return "PDO is too short";
    case PlantFaultKind::restarted: return "restarted without a command, or a second node has its node-ID";
  }
  return "unknown fault";
}

struct PlantFault {
  PlantFaultKind kind = PlantFaultKind::boot;
  BootResult boot{};
  NmtState state = NmtState::initialisation;  ///< last reported one
  EmergencyMessage emergency{};
  std::uint16_t rpdo = 0;  ///< number of the master's RPDO
};

}  // namespace canopen
