/// Bits of the controlword 6040h and the statusword 6041h (CiA 402-2, 8.4.1 and 8.4.2).
#pragma once

#include <cstdint>

namespace canopen::cia402 {

namespace controlword {

inline constexpr std::uint16_t switch_on = 0x0001;
inline constexpr std::uint16_t enable_voltage = 0x0002;
inline constexpr std::uint16_t quick_stop = 0x0004;  ///< 0 stops
inline constexpr std::uint16_t enable_operation = 0x0008;
inline constexpr std::uint16_t new_set_point = 0x0010;       ///< profile position
inline constexpr std::uint16_t start_homing = 0x0010;        ///< homing
inline constexpr std::uint16_t enable_ramp = 0x0010;         ///< velocity: 0 stops
inline constexpr std::uint16_t unlock_ramp = 0x0020;         ///< velocity: 0 keeps the present velocity
inline constexpr std::uint16_t use_reference = 0x0040;       ///< velocity: 0 is a target velocity of 0
inline constexpr std::uint16_t interpolate = 0x0010;         ///< interpolated position
inline constexpr std::uint16_t change_immediately = 0x0020;  ///< profile position
inline constexpr std::uint16_t relative = 0x0040;            ///< profile position
inline constexpr std::uint16_t fault_reset = 0x0080;         ///< with its rising edge
inline constexpr std::uint16_t halt = 0x0100;

}  // namespace controlword

namespace statusword {

inline constexpr std::uint16_t ready_to_switch_on = 0x0001;
inline constexpr std::uint16_t switched_on = 0x0002;
inline constexpr std::uint16_t operation_enabled = 0x0004;
inline constexpr std::uint16_t fault = 0x0008;
inline constexpr std::uint16_t voltage_enabled = 0x0010;
inline constexpr std::uint16_t quick_stop = 0x0020;  ///< 0: quick stop is active
inline constexpr std::uint16_t switch_on_disabled = 0x0040;
inline constexpr std::uint16_t warning = 0x0080;
inline constexpr std::uint16_t manufacturer_8 = 0x0100;
inline constexpr std::uint16_t remote = 0x0200;
inline constexpr std::uint16_t target_reached = 0x0400;
inline constexpr std::uint16_t internal_limit = 0x0800;
inline constexpr std::uint16_t set_point_acknowledge = 0x1000;  ///< profile position
inline constexpr std::uint16_t speed_is_zero = 0x1000;          ///< profile velocity
inline constexpr std::uint16_t homing_attained = 0x1000;        ///< homing
inline constexpr std::uint16_t interpolates = 0x1000;           ///< interpolated position
inline constexpr std::uint16_t follows_command = 0x1000;        ///< cyclic synchronous modes
inline constexpr std::uint16_t following_error = 0x2000;        ///< profile position, cyclic synchronous position
inline constexpr std::uint16_t homing_error = 0x2000;           ///< homing
inline constexpr std::uint16_t manufacturer_14 = 0x4000;
inline constexpr std::uint16_t manufacturer_15 = 0x8000;

}  // namespace statusword

}  // namespace canopen::cia402
