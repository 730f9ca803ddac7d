/// Network management as a slave sees it (CiA 301, 7.2.8 and 7.3.2): states, commands, and which service runs in which.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "canopen/cob_id.hpp"
#include "canopen/frame.hpp"
#include "canopen/node_id.hpp"

namespace canopen {

/// The states with the codes that a heartbeat carries (CiA 301, 7.2.8.3.2.2).
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
inline constexpr std::uint32_t start_all = 0x02;       ///< slaves are started by one command to all, not one by one
inline constexpr std::uint32_t no_self_start = 0x04;   ///< this device does not enter Operational by itself
inline constexpr std::uint32_t no_slave_start = 0x08;  ///< slaves are not started: the application does it
inline constexpr std::uint32_t reset_all = 0x10;       ///< a mandatory slave that is lost: all nodes are reset
inline constexpr std::uint32_t flying_master = 0x20;
inline constexpr std::uint32_t stop_all = 0x40;  ///< a mandatory slave that is lost: all nodes are stopped
}  // namespace nmt_start_up

/// Pre-operational and Operational: their codes are the odd ones.
[[nodiscard]] constexpr bool serves_sdo(NmtState state) { return (static_cast<unsigned>(state) & 1) != 0; }

/// SYNC and TIME.
[[nodiscard]] constexpr bool serves_sync(NmtState state) { return serves_sdo(state); }
[[nodiscard]] constexpr bool serves_emcy(NmtState state) { return serves_sdo(state); }

[[nodiscard]] constexpr bool serves_pdo(NmtState state) { return state == NmtState::operational; }

/// Whether a frame brings a command to this node, which may be none of the five.
[[nodiscard]] constexpr bool is_nmt_command(const Frame& frame, NodeId node_id) {
  if (frame.id != function_code::nmt || frame.extended || frame.remote || frame.size < 2) return false;
  return frame.data[1] == 0 || frame.data[1] == node_id.value();
}

/// The command that a frame brings to this node: two bytes or more on CAN-ID 0, for this node-ID or for all (0).
/// Nothing when it is for another node, shorter, or not one of the five commands.
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
