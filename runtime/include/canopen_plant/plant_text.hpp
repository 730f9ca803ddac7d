/// Texts for the log of a plant on a host.
#pragma once

#include <cstdio>
#include <span>
#include <string>

#include "canopen/host/master_text.hpp"
#include "canopen_plant/plant_errors.hpp"
#include "canopen_plant/plant_fault.hpp"
#include "canopen_plant/plant_node.hpp"
#include "canopen_plant/plant_place.hpp"

namespace canopen {

/// `axis1: lost, last state operational`, `axis1: product code 1018h:02 is not the one of 1F86h: expected ...`; a node
/// that the network file does not list is `node 9`. With the `places` of the network, a failed boot-up begins with the
/// line that it contradicts: `eds/drive.eds:120: axis1: ...`. With its `errors`, an EMCY has the name that the device
/// gives to the error code: `axis1: EMCY 2310h: continuous over current`.
[[nodiscard]] inline std::string fault_text(const PlantNode& node, const PlantFault& fault,
                                            std::span<const PlantPlace> places = {},
                                            std::span<const PlantErrors> errors = {}) {
  const std::string who = node.name.empty() ? "node " + std::to_string(node.node_id.value()) : std::string{node.name};
  if (fault.kind == PlantFaultKind::boot) {
    const PlantPlace* const place = find_place(places, node.node_id, fault.boot);
    const std::string text = boot_text(who, fault.boot);
    return place == nullptr ? text : std::string{place->file} + ":" + std::to_string(place->line) + ": " + text;
  }
  std::string text = who + ": " + std::string{to_text(fault.kind)};
  switch (fault.kind) {
    case PlantFaultKind::lost: return text + ", last state " + std::string{to_text(fault.state)};
    case PlantFaultKind::unexpected_state:
    case PlantFaultKind::toggle_error: return text + ": " + std::string{to_text(fault.state)};
    case PlantFaultKind::emergency: {
      char code[8];
      std::snprintf(code, sizeof code, " %04Xh", unsigned{fault.emergency.code});
      return text + code + ": " + std::string{error_text(errors, node.node_id, fault.emergency.code)};
    }
    case PlantFaultKind::pdo_missing:
    case PlantFaultKind::pdo_too_short: return text + ": RPDO " + std::to_string(fault.rpdo) + " of the master";
    case PlantFaultKind::boot:
    case PlantFaultKind::restarted:
    case PlantFaultKind::not_watched:
    case PlantFaultKind::emergency_over: break;
  }
  return text;
}

}  // namespace canopen
