/// The power drive system finite state automaton: states, commands and transitions as tables (CiA 402-2, 7.2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

enum class State : std::uint8_t {
  not_ready_to_switch_on,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
};

/// Bits 0..3, 5 and 6 of the statusword in each state. Bit 5 is 0 where the standard does not define it.
inline constexpr std::array<std::uint16_t, 8> state_bits = {
    0x0000,  // not ready to switch on
    0x0040,  // switch on disabled
    0x0021,  // ready to switch on
    0x0023,  // switched on
    0x0027,  // operation enabled
    0x0007,  // quick stop active
    0x000F,  // fault reaction active
    0x0008,  // fault
};

[[nodiscard]] constexpr std::uint16_t bits_of(State state) { return state_bits[static_cast<std::size_t>(state)]; }

/// Whether the standard does not define bit 5 of the statusword in this state.
[[nodiscard]] constexpr bool quick_stop_bit_is_open(State state) {
  return state == State::not_ready_to_switch_on || state == State::switch_on_disabled || state == State::fault ||
         state == State::fault_reaction_active;
}

/// Whether torque may be applied to the motor.
[[nodiscard]] constexpr bool has_power(State state) {
  return state == State::operation_enabled || state == State::quick_stop_active ||
         state == State::fault_reaction_active;
}

/// Commands in bits 0..3 and 7 of the controlword. Fault reset, the rising edge of bit 7, is not one of them.
enum class Command : std::uint8_t {
  none,
  disable_voltage,
  quick_stop,
  shutdown,
  switch_on,  ///< also disable operation, depending on the state
  enable_operation,
};

struct CommandBits {
  std::uint16_t mask;
  std::uint16_t value;
  Command command;
};

inline constexpr CommandBits command_bits[] = {
    {0x0082, 0x0000, Command::disable_voltage},  {0x0086, 0x0002, Command::quick_stop},
    {0x0087, 0x0006, Command::shutdown},         {0x008F, 0x0007, Command::switch_on},
    {0x008F, 0x000F, Command::enable_operation},
};

[[nodiscard]] constexpr Command command_of(std::uint16_t controlword) {
  for (const CommandBits& row : command_bits) {
    if ((controlword & row.mask) == row.value) return row.command;
  }
  return Command::none;
}

struct Transition {
  std::uint8_t number;
  State from;
  Command command;
  State to;
};

/// Transitions by commands. Others are automatic: 0 and 1 at power-on, 12 at the end of a quick stop, 13 and 14 with a
/// fault, 15 with fault reset. Enable operation passes through Switched On.
inline constexpr Transition transitions[] = {
    {2, State::switch_on_disabled, Command::shutdown, State::ready_to_switch_on},
    {3, State::ready_to_switch_on, Command::switch_on, State::switched_on},
    {3, State::ready_to_switch_on, Command::enable_operation, State::switched_on},
    {4, State::switched_on, Command::enable_operation, State::operation_enabled},
    {5, State::operation_enabled, Command::switch_on, State::switched_on},
    {6, State::switched_on, Command::shutdown, State::ready_to_switch_on},
    {7, State::ready_to_switch_on, Command::quick_stop, State::switch_on_disabled},
    {7, State::ready_to_switch_on, Command::disable_voltage, State::switch_on_disabled},
    {8, State::operation_enabled, Command::shutdown, State::ready_to_switch_on},
    {9, State::operation_enabled, Command::disable_voltage, State::switch_on_disabled},
    {10, State::switched_on, Command::quick_stop, State::switch_on_disabled},
    {10, State::switched_on, Command::disable_voltage, State::switch_on_disabled},
    {11, State::operation_enabled, Command::quick_stop, State::quick_stop_active},
    {12, State::quick_stop_active, Command::disable_voltage, State::switch_on_disabled},
    {16, State::quick_stop_active, Command::enable_operation, State::operation_enabled},
};

/// Returns the transition of a command; null if it has no effect in this state.
[[nodiscard]] constexpr const Transition* transition_of(State from, Command command) {
  for (const Transition& row : transitions) {
    if (row.from == from && row.command == command) return &row;
  }
  return nullptr;
}

}  // namespace canopen::cia402
