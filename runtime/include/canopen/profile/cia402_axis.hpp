/// The axis of a CiA 402 drive: power stage, trajectory, position and switches, in the units of the objects.
#pragma once

#include <concepts>
#include <cstdint>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_option_code.hpp"

namespace canopen::cia402 {

/// Limits of a movement: 6081h, 6083h and 6084h.
struct Profile {
  std::uint32_t velocity;
  std::uint32_t acceleration;
  std::uint32_t deceleration;
  friend constexpr bool operator==(const Profile&, const Profile&) = default;
};

/// Inputs as bits of 60FDh (CiA 402-2, 10.5.7).
namespace input {
inline constexpr std::uint8_t negative_limit = 0x1;
inline constexpr std::uint8_t positive_limit = 0x2;
inline constexpr std::uint8_t home_switch = 0x4;
}  // namespace input

/// Whether a limit switch blocks motion in this direction.
[[nodiscard]] constexpr bool limit_switch_blocks(std::uint32_t inputs, std::int32_t direction) {
  return direction != 0 && (inputs & (direction > 0 ? input::positive_limit : input::negative_limit)) != 0;
}

/// A command replaces the previous one; ramps of 0 are as steep as the axis allows.
template <class Type>
concept Axis = requires(Type& axis, const Type& state, std::int32_t number, std::uint32_t deceleration,
                        const Profile& profile, bool on, Duration span) {
  axis.enable(on);                                     ///< power stage; off: the motor coasts
  axis.move_to(number, profile);                       ///< to a position
  axis.run_at(number, profile);                        ///< at a velocity, limited only by the ramps
  axis.stop(deceleration);                             ///< to standstill, under control
  axis.follow(number);                                 ///< a position that is updated at each step
  axis.set_position(number);                           ///< assigns this position to the present location
  axis.step(span);                                     ///< elapsed time; has no effect if hardware moves by itself
  { state.moving() } -> std::same_as<bool>;            ///< the trajectory has not ended
  { state.position() } -> std::same_as<std::int32_t>;  ///< actual
  { state.velocity() } -> std::same_as<std::int32_t>;  ///< actual
  { state.position_demand() } -> std::same_as<std::int32_t>;
  { state.velocity_demand() } -> std::same_as<std::int32_t>;
  { state.inputs() } -> std::same_as<std::uint32_t>;  ///< bits of `input`
  { axis.index_pulse() } -> std::same_as<bool>;       ///< one has occurred since the last call
};

/// Stops an axis. An axis whose deceleration depends on the kind of braking, for example by a current limit, has
/// stop(deceleration, braking).
template <Axis Type>
constexpr void stop(Type& axis, std::uint32_t deceleration, [[maybe_unused]] Braking braking) {
  if constexpr (requires { axis.stop(deceleration, braking); }) {
    axis.stop(deceleration, braking);
  } else {
    axis.stop(deceleration);
  }
}

/// Functions of an axis of a drive with a torque mode. Torque is in 0.1 % of the rated torque 6076h, as 6071h.
template <class Type>
concept TorqueAxis = Axis<Type> && requires(Type& axis, const Type& state, std::int16_t torque) {
  axis.apply_torque(torque);                         ///< until the next command; limited only by the hardware
  { state.torque() } -> std::same_as<std::int16_t>;  ///< actual
};

/// The signal of a touch probe and its edge.
struct ProbeEdge {
  std::uint8_t probe;   ///< 1 or 2
  std::int16_t source;  ///< as 60D0h: 1 to 4 an input, 5 and 6 the zero impulse of the position encoder
  bool positive;        ///< the edge

  friend constexpr bool operator==(const ProbeEdge&, const ProbeEdge&) = default;
};

/// Function of an axis of a drive with touch probes (60B8h): returns the position at the last such edge since the last
/// call. Hardware latches it; an axis that samples the signal returns the position at the step in which it has changed.
template <class Type>
concept ProbedAxis = Axis<Type> && requires(Type& axis, const ProbeEdge& edge) {
  { axis.latched(edge) } -> std::same_as<std::optional<std::int32_t>>;
};

}  // namespace canopen::cia402
