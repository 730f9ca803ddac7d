/// Request NMT 1F82h of an NMT master: other devices read the states of its slaves, and send commands (CiA 302-2).
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"

namespace canopen {

/// A value that is written to 1F82h, and its command.
struct RequestedCommand {
  std::uint8_t value;
  NmtCommand command;
};

/// The states have the codes of a heartbeat.
inline constexpr RequestedCommand requested_commands[] = {
    {4, NmtCommand::stop},
    {5, NmtCommand::start},
    {6, NmtCommand::reset_node},
    {7, NmtCommand::reset_communication},
    {127, NmtCommand::enter_pre_operational},
};

/// Sub-index of 1F82h for all nodes; 1 to 127 are the node-IDs.
inline constexpr std::uint8_t request_nmt_all_nodes = 128;

/// Writes an entry of 1F82h: sends the command to the node, or to all nodes. 0609 0011h: there is no such sub-index;
/// 0609 0030h: the value is not a command; 0800 0022h: the bus has no room.
template <class Master>
[[nodiscard]] AbortCode write_request_nmt(Master& master, std::uint8_t sub_index, std::uint8_t value) {
  if (sub_index == 0 || sub_index > request_nmt_all_nodes) return AbortCode::no_sub_index;
  const NodeId node_id{sub_index == request_nmt_all_nodes ? std::uint8_t{0} : sub_index};
  for (const RequestedCommand& row : requested_commands) {
    if (row.value == value) return master.command(row.command, node_id) ? ok : AbortCode::device_state;
  }
  return AbortCode::invalid_value;
}

/// Returns the value of an entry of 1F82h: the last state that the slave reported; 1: it does not respond; 0: its state
/// is unknown, for instance because it is not monitored.
template <class Master>
[[nodiscard]] std::uint8_t read_request_nmt(const Master& master, std::uint8_t node_id) {
  constexpr std::uint8_t unknown = 0;
  constexpr std::uint8_t missing = 1;
  const NodeId slave{node_id};
  if (const std::optional<NmtState> state = master.state(slave)) return static_cast<std::uint8_t>(*state);
  return master.status(slave) == BootStatus::no_response ? missing : unknown;
}

}  // namespace canopen
