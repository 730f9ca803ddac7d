/// The reactions of a drive that the option codes 6007h and 605Ah to 605Eh select (CiA 402-2).
#pragma once

#include <cstdint>

namespace canopen::cia402 {

enum class Braking : std::uint8_t {
  none,             ///< power is switched off, the motor coasts
  slow_down_ramp,   ///< with the profile deceleration 6084h
  quick_stop_ramp,  ///< with the quick stop deceleration 6085h
  hardest,          ///< at the limit of current or voltage
};

namespace option_code {

/// 6007h: the action on loss of communication.
inline constexpr std::int16_t no_action = 0;
inline constexpr std::int16_t fault_signal = 1;
inline constexpr std::int16_t disable_voltage = 2;
inline constexpr std::int16_t quick_stop_command = 3;

// Values if the object does not exist.
inline constexpr std::int16_t abort_connection = fault_signal;
inline constexpr std::int16_t quick_stop = 2;
inline constexpr std::int16_t shutdown = 0;
inline constexpr std::int16_t disable_operation = 1;
inline constexpr std::int16_t halt = 1;
inline constexpr std::int16_t fault_reaction = 2;

/// Whether the drive stays in Quick Stop Active after a quick stop with this value of 605Ah.
[[nodiscard]] constexpr bool stays_in_quick_stop(std::int16_t code) { return code >= 5 && code <= 8; }

}  // namespace option_code

/// Returns the braking of any option code. Manufacturer-specific codes brake as hard as possible.
[[nodiscard]] constexpr Braking braking_of(std::int16_t code) {
  switch (code) {
    case 0: return Braking::none;
    case 1:
    case 5: return Braking::slow_down_ramp;
    case 2:
    case 6: return Braking::quick_stop_ramp;
    default: return Braking::hardest;
  }
}

}  // namespace canopen::cia402
