/// Texts for the log of a master on a host.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/nmt/nmt.hpp"
#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/nmt_master.hpp"

namespace canopen {

/// `axis1: product code 1018h:02 is not the one of 1F86h: expected 00010001h, seen 00020001h`
[[nodiscard]] inline std::string boot_text(std::string_view who, const BootResult& result) {
  const auto print = [](const char* format, auto... numbers) {
    char text[64];
    std::snprintf(text, sizeof text, format, numbers...);
    return std::string{text};
  };
  const bool answered_1000h = result.status == BootStatus::no_response && result.index > 0x1000;
  std::string text = std::string{who} + ": " + (answered_1000h ? "no answer" : std::string{to_text(result.status)});
  if (result.abort_code != ok) {
    const auto code = unsigned{code_in_frame(result.abort_code)};
    if (result.index != 0) text += print(": %04Xh:%02X", unsigned{result.index}, unsigned{result.sub_index});
    text += print(": %04X %04Xh, ", code >> 16, code & 0xFFFF) + std::string{to_text(result.abort_code)};
  } else if (result.status == BootStatus::heartbeat_rate) {
    text += print(": expected %u ms, seen %u ms", unsigned{result.expected}, unsigned{result.seen});
  } else if (result.index != 0 && result.status == BootStatus::extra_response) {
    text += print(": %04Xh:%02X", unsigned{result.index}, unsigned{result.sub_index});
  } else if (result.index != 0) {
    if (result.status == BootStatus::not_as_written) {
      text += print(": %04Xh:%02X", unsigned{result.index}, unsigned{result.sub_index});
    }
    text += print(": expected %08Xh, seen %08Xh", unsigned{result.expected}, unsigned{result.seen});
  }
  return text;
}

/// `node 5: no answer, or device type 1000h could not be read: 1000h:00: ...`
[[nodiscard]] inline std::string boot_text(NodeId node_id, const BootResult& result) {
  return boot_text("node " + std::to_string(node_id.value()), result);
}

/// `node 5: lost, last state operational`. The parameters are those of `on_event`.
[[nodiscard]] inline std::string event_text(NmtMasterEvent event, NodeId node_id, NmtState state) {
  std::string text = "node " + std::to_string(node_id.value()) + ": " + std::string{to_text(event)};
  const bool has_state =
      event != NmtMasterEvent::boot_up && event != NmtMasterEvent::not_watched && event != NmtMasterEvent::restarted;
  if (has_state) text += (event == NmtMasterEvent::lost ? ", last state " : ": ") + std::string{to_text(state)};
  return text;
}

}  // namespace canopen
