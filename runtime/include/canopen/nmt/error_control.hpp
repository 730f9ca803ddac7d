/// Error control messages of a node with CAN-ID 700h + node-ID: boot-up, heartbeat and node guarding (CiA 301,
/// 7.2.8.3.2).
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// One message of one byte. `initialisation` is the boot-up message.
struct ErrorControlMessage {
  NodeId node_id;
  NmtState state;
  bool toggle;  ///< bit 7: alternates in guarding responses, 0 in heartbeats and boot-up messages
};

/// Returns the message in a frame; empty if it is a different frame, has a different length, or contains a state that
/// is not defined by CiA 301.
[[nodiscard]] constexpr std::optional<ErrorControlMessage> error_control_message(const Frame& frame) {
  if (frame.extended || frame.remote || frame.size != 1) return std::nullopt;
  if (frame.id <= function_code::error_control || frame.id > function_code::error_control + 0x7Fu) return std::nullopt;
  const NodeId node_id{static_cast<std::uint8_t>(frame.id & 0x7F)};
  const auto state = static_cast<NmtState>(frame.data[0] & 0x7F);
  switch (state) {
    case NmtState::initialisation:
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::pre_operational: return ErrorControlMessage{node_id, state, (frame.data[0] & 0x80) != 0};
  }
  return std::nullopt;
}

/// The last state that a node reported, in a byte that is 0 if it has not reported one: services with one per node are
/// initialised to zeros.
class LastState {
 public:
  constexpr LastState() = default;
  constexpr explicit LastState(NmtState state)
      : code_{state == NmtState::initialisation ? boot_up : static_cast<std::uint8_t>(state)} {}

  [[nodiscard]] constexpr bool known() const { return code_ != 0; }

  /// Initialisation if it is not known.
  [[nodiscard]] constexpr NmtState state() const {
    return code_ <= boot_up ? NmtState::initialisation : static_cast<NmtState>(code_);
  }

  friend constexpr bool operator==(LastState, LastState) = default;

 private:
  static constexpr std::uint8_t boot_up = 1;  ///< no state has this code

  std::uint8_t code_ = 0;
};

}  // namespace canopen
