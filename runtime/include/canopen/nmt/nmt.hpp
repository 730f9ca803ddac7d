/// Network management of a slave (CiA 301, 7.2.8 and 7.3.2): states, commands, and which service runs in which state.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"

namespace canopen {

/// The NMT states, with the codes of a heartbeat (CiA 301, 7.2.8.3.2.2).
enum class NmtState : std::uint8_t {
  initialisation = 0,
  stopped = 4,
  operational = 5,
  pre_operational = 127,
};

[[nodiscard]] constexpr std::string_view to_text(NmtState state) {
  switch (state) {
    case NmtState::initialisation: return "initialisation";
    case NmtState::stopped: return "stopped";
    case NmtState::operational: return "operational";
    case NmtState::pre_operational: return "pre-operational";
  }
  return "unknown state";
}

/// The commands of an NMT master (CiA 301, 7.2.8.3.1).
enum class NmtCommand : std::uint8_t {
  start = 1,
  stop = 2,
  enter_pre_operational = 128,
  reset_node = 129,
  reset_communication = 130,
};

/// Bits of NMT start-up 1F80h (CiA 302-2).
namespace nmt_start_up {
inline constexpr std::uint32_t master = 0x01;          ///< this device is the NMT master
inline constexpr std::uint32_t start_all = 0x02;       ///< slaves are started by one command to all nodes
inline constexpr std::uint32_t no_self_start = 0x04;   ///< this device does not enter Operational by itself
inline constexpr std::uint32_t no_slave_start = 0x08;  ///< slaves are not started: the application does it
inline constexpr std::uint32_t reset_all = 0x10;       ///< all nodes are reset if a mandatory slave is lost
inline constexpr std::uint32_t flying_master = 0x20;
inline constexpr std::uint32_t stop_all = 0x40;  ///< all nodes are stopped if a mandatory slave is lost
}  // namespace nmt_start_up

/// True in Pre-operational and Operational, whose codes are odd.
[[nodiscard]] constexpr bool serves_sdo(NmtState state) { return (static_cast<unsigned>(state) & 1) != 0; }

/// For SYNC and TIME.
[[nodiscard]] constexpr bool serves_sync(NmtState state) { return serves_sdo(state); }
[[nodiscard]] constexpr bool serves_emcy(NmtState state) { return serves_sdo(state); }

[[nodiscard]] constexpr bool serves_pdo(NmtState state) { return state == NmtState::operational; }

/// Whether a frame is a command to this node; its code may be invalid.
[[nodiscard]] constexpr bool is_nmt_command(const Frame& frame, NodeId node_id) {
  if (frame.id != function_code::nmt || frame.extended || frame.remote || frame.size < 2) return false;
  return frame.data[1] == 0 || frame.data[1] == node_id.value();
}

/// Returns the command to this node in a frame: two bytes or more with CAN-ID 0, for this node-ID or for all (0). Empty
/// if it is for another node, shorter, or not one of the five commands.
[[nodiscard]] constexpr std::optional<NmtCommand> nmt_command(const Frame& frame, NodeId node_id) {
  if (!is_nmt_command(frame, node_id)) return std::nullopt;
  const auto command = static_cast<NmtCommand>(frame.data[0]);
  switch (command) {
    case NmtCommand::start:
    case NmtCommand::stop:
    case NmtCommand::enter_pre_operational:
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication: return command;
  }
  return std::nullopt;
}

}  // namespace canopen
