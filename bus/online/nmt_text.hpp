/// NMT states and commands as text.
#pragma once

#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <optional>
#include <string_view>

namespace edsc {

struct NmtStateText {
  canopen::NmtState state;
  std::string_view text;
};

inline constexpr NmtStateText nmt_state_texts[] = {
    {canopen::NmtState::initialisation, "boot-up"},
    {canopen::NmtState::stopped, "stopped"},
    {canopen::NmtState::operational, "operational"},
    {canopen::NmtState::pre_operational, "pre-operational"},
};

[[nodiscard]] constexpr std::string_view nmt_state_text(canopen::NmtState state) {
  for (const auto& row : nmt_state_texts) {
    if (row.state == state) return row.text;
  }
  return "unknown";
}

struct NmtCommandText {
  canopen::NmtCommand command;
  std::string_view text;       ///< argument of `edsc nmt`
  canopen::NmtState leads_to;  ///< for a reset, confirmed by the boot-up message
};

inline constexpr NmtCommandText nmt_command_texts[] = {
    {canopen::NmtCommand::start, "start", canopen::NmtState::operational},
    {canopen::NmtCommand::stop, "stop", canopen::NmtState::stopped},
    {canopen::NmtCommand::enter_pre_operational, "pre-operational", canopen::NmtState::pre_operational},
    {canopen::NmtCommand::reset_node, "reset-node", canopen::NmtState::initialisation},
    {canopen::NmtCommand::reset_communication, "reset-communication", canopen::NmtState::initialisation},
};

[[nodiscard]] constexpr const NmtCommandText* find_nmt_command(std::string_view text) {
  for (const auto& row : nmt_command_texts) {
    if (row.text == text) return &row;
  }
  return nullptr;
}

}  // namespace edsc
