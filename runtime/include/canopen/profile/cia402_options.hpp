/// Modes of operation, and behaviour of a drive that differs from CiA 402-2 or that it leaves open.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/profile/cia402_axis.hpp"

namespace canopen::cia402 {

/// Values of 6060h. Negative ones are manufacturer-specific.
namespace mode {
inline constexpr std::int8_t none = 0;
inline constexpr std::int8_t profile_position = 1;
inline constexpr std::int8_t velocity = 2;
inline constexpr std::int8_t profile_velocity = 3;
inline constexpr std::int8_t profile_torque = 4;
inline constexpr std::int8_t homing = 6;
inline constexpr std::int8_t interpolated_position = 7;
inline constexpr std::int8_t cyclic_synchronous_position = 8;
inline constexpr std::int8_t cyclic_synchronous_velocity = 9;
inline constexpr std::int8_t cyclic_synchronous_torque = 10;
}  // namespace mode

/// Returns the bit of a mode in 6502h.
[[nodiscard]] constexpr std::uint32_t bit_of_mode(std::int8_t mode) {
  return mode >= 1 && mode <= 16 ? 1u << (mode - 1) : 0;
}

/// The modes of the profile, as bits of 6502h.
inline constexpr std::uint32_t implemented_modes =
    bit_of_mode(mode::profile_position) | bit_of_mode(mode::velocity) | bit_of_mode(mode::profile_velocity) |
    bit_of_mode(mode::profile_torque) | bit_of_mode(mode::homing) | bit_of_mode(mode::interpolated_position) |
    bit_of_mode(mode::cyclic_synchronous_position) | bit_of_mode(mode::cyclic_synchronous_velocity) |
    bit_of_mode(mode::cyclic_synchronous_torque);

/// The modes of a drive whose EDS does not list them in 6502h.
inline constexpr std::uint32_t usual_modes = bit_of_mode(mode::profile_position) | bit_of_mode(mode::profile_velocity) |
                                             bit_of_mode(mode::homing) | bit_of_mode(mode::cyclic_synchronous_position);

/// A conversion factor.
struct Ratio {
  std::int32_t numerator = 1;
  std::int32_t denominator = 1;
};

struct Options {
  /// Supported modes, as bits of 6502h. 0: those of 6502h in the EDS; `usual_modes` if the EDS does not list them. Code
  /// for other modes is not in the image.
  std::uint32_t modes = 0;
  /// Manufacturer-specific modes: from this one to -1. 0: those that 6060h accepts by the EDS.
  std::int8_t lowest_mode = 0;
  /// The axis of a device with several ones, 0 to 7: its objects are 800h after those of the axis before it.
  std::uint8_t axis = 0;
  /// The mode of a drive without 6060h.
  std::int8_t initial_mode = mode::none;
  /// The drive goes from Switch On Disabled to Ready To Switch On automatically.
  bool ready_without_shutdown = false;
  /// Bit 10 of the statusword keeps its value until the motion of a new set-point or of a homing starts, with the next
  /// step. If false, it is reset with the command.
  bool target_reached_until_motion = false;
  /// In profile velocity, bit 12 of the statusword indicates that the speed is zero.
  bool tells_speed_is_zero = true;
  /// Bit 11 of the statusword also indicates software limits. If false, only limit switches.
  bool tells_software_limits = true;
  /// A heartbeat or life guarding event and bus-off are a fault even if the axis has no power. If false, 6007h applies
  /// only to an axis with power.
  bool faults_without_power = false;
  /// Maximum number of steps to catch up if `on_time` was called late. Time beyond them is skipped, so that the axis
  /// does not jump and a call takes bounded time.
  std::uint16_t max_steps = 100;
  /// Data records that interpolated position mode can buffer, if the device has 60C4h: 4 bytes of RAM each; at most
  /// 255.
  std::uint16_t interpolation_buffer = 8;
  /// Time between two steps of the axis, in us.
  std::uint32_t step = 1'000;
  /// Interval in us at which actual values are set while the axis moves. They are always set when it has come to rest.
  std::uint32_t actual_values = 1'000;
  /// For a drive without 6081h, 6083h, 6084h.
  Profile profile{};
  /// For a drive without 609Ah.
  std::uint32_t homing_acceleration = 0;
  /// Velocity and acceleration of the axis for 1 rpm and 1 rpm/s, the units of velocity mode (6042h, 6048h).
  Ratio velocity_of_rpm{};
  Ratio acceleration_of_rpm{};
};
// In a template parameter with padding, Clang 14 reads members of class type at wrong offsets.
static_assert(std::has_unique_object_representations_v<Options>);

}  // namespace canopen::cia402
