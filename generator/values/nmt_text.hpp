/// NMT states and commands as text.
#pragma once

#include <algorithm>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace edsc {

/// `boot-up` for the state that only a boot-up message reports.
[[nodiscard]] constexpr std::string_view nmt_state_text(canopen::NmtState state) {
  return state == canopen::NmtState::initialisation ? "boot-up" : canopen::to_text(state);
}

struct NmtCommandText {
  canopen::NmtCommand command;
  std::string_view argument;   ///< of `edsc nmt`
  std::string_view text;       ///< `enter pre-operational`
  canopen::NmtState leads_to;  ///< for a reset, confirmed by the boot-up message
};

inline constexpr NmtCommandText nmt_command_texts[] = {
    {canopen::NmtCommand::start, "start", "start", canopen::NmtState::operational},
    {canopen::NmtCommand::stop, "stop", "stop", canopen::NmtState::stopped},
    {canopen::NmtCommand::enter_pre_operational, "pre-operational", "enter pre-operational",
     canopen::NmtState::pre_operational},
    {canopen::NmtCommand::reset_node, "reset-node", "reset node", canopen::NmtState::initialisation},
    {canopen::NmtCommand::reset_communication, "reset-communication", "reset communication",
     canopen::NmtState::initialisation},
};

/// The row with this value of a member: a command, or an argument. Null if there is none.
template <class Value>
[[nodiscard]] constexpr const NmtCommandText* find_nmt_command(Value NmtCommandText::*member, const Value& value) {
  const auto* row = std::ranges::find(nmt_command_texts, value, member);
  return row == std::end(nmt_command_texts) ? nullptr : row;
}

/// `enter pre-operational`; empty if CiA 301 does not have the command.
[[nodiscard]] constexpr std::string_view nmt_command_text(canopen::NmtCommand command) {
  const NmtCommandText* const row = find_nmt_command(&NmtCommandText::command, command);
  return row == nullptr ? std::string_view{} : row->text;
}

}  // namespace edsc
