/// Error control messages: what a node tells on 700h + node-ID by boot-up, heartbeat or node guarding (CiA
/// 301, 7.2.8.3.2).
#pragma once

#include <cstdint>
#include <optional>

#include "canopen/cob_id.hpp"
#include "canopen/frame.hpp"
#include "canopen/nmt.hpp"
#include "canopen/node_id.hpp"

namespace canopen {

/// One message: one byte. `initialisation` is the boot-up message.
struct ErrorControlMessage {
  NodeId node_id;
  NmtState state;
  bool toggle;  ///< bit 7: alternates in the answers of node guarding, 0 in heartbeats and boot-up messages
};

/// The message that a frame brings; nothing when it is another one, of another length, or tells a state that CiA 301
/// does not know.
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

/// The state that a node has told last, in a byte that is 0 while it has told none: services that have one for each
/// node begin as zeroes.
class LastState {
 public:
  constexpr LastState() = default;
  constexpr explicit LastState(NmtState state)
      : code_{state == NmtState::initialisation ? boot_up : static_cast<std::uint8_t>(state)} {}

  [[nodiscard]] constexpr bool known() const { return code_ != 0; }

  /// Initialisation while none is known.
  [[nodiscard]] constexpr NmtState state() const {
    return code_ <= boot_up ? NmtState::initialisation : static_cast<NmtState>(code_);
  }

  friend constexpr bool operator==(LastState, LastState) = default;

 private:
  static constexpr std::uint8_t boot_up = 1;  ///< no state has this code

  std::uint8_t code_ = 0;
};

}  // namespace canopen
