/// Commands of an NMT master, and the events of its slaves.
#pragma once

#include <cstdint>
#include <string_view>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Returns the frame of a command to one node, or to all nodes with node-ID 0.
[[nodiscard]] constexpr Frame nmt_frame(NmtCommand command, NodeId node_id) {
  Frame frame{};
  frame.id = function_code::nmt;
  frame.size = 2;
  frame.data[0] = static_cast<std::uint8_t>(command);
  frame.data[1] = node_id.value();
  return frame;
}

/// Events of a slave.
enum class NmtMasterEvent : std::uint8_t {
  boot_up,           ///< its boot-up message
  state_changed,     ///< its first state, or a different one
  unexpected_state,  ///< a state other than the one of the last command since its boot-up
  toggle_error,      ///< guarding: a response with the same toggle bit as the previous one
  lost,              ///< no heartbeat or guarding response within its time
  back,              ///< the first one after it was lost
  not_watched,       ///< it has booted, but its loss will not be detected: the list has no heartbeat and no guarding
                     ///< times for it
  restarted,         ///< the boot-up message of a booted slave that was not reset by a command of the master
};

[[nodiscard]] constexpr std::string_view to_text(NmtMasterEvent event) {
  switch (event) {
    case NmtMasterEvent::boot_up: return "boot-up";
    case NmtMasterEvent::state_changed: return "NMT state changed";
    case NmtMasterEvent::unexpected_state: return "NMT state is not the commanded one";
    case NmtMasterEvent::toggle_error: return "toggle bit of node guarding did not alternate";
    case NmtMasterEvent::lost: return "lost";
    case NmtMasterEvent::back: return "back";
    case NmtMasterEvent::not_watched: return "not watched: no heartbeat time and no guard time in the network list";
    case NmtMasterEvent::restarted: return "restarted without a command, or a second node has its node-ID";
  }
  return "unknown event";
}

}  // namespace canopen
