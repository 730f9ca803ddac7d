/// Modes of operation of a drive: profile position, velocity, profile velocity, profile torque, homing, interpolated
/// position, and cyclic synchronous position, velocity and torque (CiA 402-2).
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_conditions.hpp"
#include "canopen/profile/cia402_homing.hpp"
#include "canopen/profile/cia402_interpolation.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_option_code.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"
#include "canopen/profile/cia402_set_points.hpp"
#include "canopen/profile/cia402_torque.hpp"
#include "canopen/profile/cia402_velocity.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

/// The present mode, its bits of the controlword, and what it commands the axis. Device control decides when a mode
/// operates. Modes that the drive does not have are not in the image.
template <class Device, Axis AxisType, Options options>
class Modes {
  using DriveParameters = Parameters<Device, options>;

 public:
  static constexpr bool has_torque =
      DriveParameters::has_mode(mode::profile_torque) || DriveParameters::has_mode(mode::cyclic_synchronous_torque);
  static constexpr bool has_velocity = DriveParameters::has_mode(mode::velocity);
  static constexpr bool has_interpolation = DriveParameters::has_mode(mode::interpolated_position);
  static_assert(!has_torque || TorqueAxis<AxisType>,
                "this drive has a torque mode: its axis needs apply_torque() and torque(), profile/cia402_axis.hpp");

  [[nodiscard]] std::int8_t present() const { return mode_; }
  [[nodiscard]] const Homing& homing() const { return homing_; }
  [[nodiscard]] const SetPoints& set_points() const { return set_points_; }

  /// Sets the mode of a drive without 6060h.
  void select(std::int8_t wanted) { selected_ = wanted; }

  /// Returns the mode that is requested.
  template <class Node>
  [[nodiscard]] std::int8_t wanted(const Node& node) const {
    return DriveParameters::template value<object::ModesOfOperation>(node, selected_);
  }

  /// Power-on, or a reset that restarts the drive.
  void restart() {
    set_points_.clear();
    homing_.interrupt();
    interpolated_.clear();
    torque_.clear();
    mode_ = options.initial_mode;
  }

  /// Changes the mode of an axis at standstill.
  void change(std::int8_t wanted) {
    restart();
    mode_ = wanted;
    velocity_told_ = false;
    motion_.clear();
  }

  /// The drive enters Operation Enabled.
  void begin() {
    velocity_told_ = false;
    motion_.clear();
  }

  /// The drive leaves Operation Enabled.
  void end() {
    set_points_.clear();
    interrupt_homing();
    homing_starts_ = false;
    interpolated_.clear();
    torque_.clear();
  }

  void interrupt_homing() { homing_.interrupt_running(); }

  /// Continues the motion that was stopped.
  void resume() {
    set_points_.start_again();
    velocity_told_ = false;
    motion_.clear();
    torque_.clear();
  }

  /// Whether the mode controls the torque of the axis.
  [[nodiscard]] bool controls_torque() const {
    return has_torque && (mode_ == mode::profile_torque || mode_ == mode::cyclic_synchronous_torque);
  }
  [[nodiscard]] std::int16_t torque_demand() const { return torque_.demand(); }  ///< 6074h

  /// Whether a limit of the mode is active: bit 11 of the statusword.
  [[nodiscard]] bool limited() const { return has_torque && controls_torque() && torque_.limited(); }

  /// Whether the demand has reached the target of velocity or profile torque mode.
  [[nodiscard]] bool at_target(const AxisType& axis) const {
    if (has_torque && mode_ == mode::profile_torque) return torque_.reached();
    return has_velocity && velocity_told_ && axis.velocity_demand() == told_velocity_;
  }

  /// Whether a set-point of profile or interpolated position mode has not been reached.
  [[nodiscard]] bool has_set_point() const {
    return set_points_.active() || (has_interpolation && !interpolated_.at_rest());
  }

  /// Returns the deceleration of a braking with power in this mode; 0: as hard as possible.
  template <class Node>
  [[nodiscard]] std::uint32_t deceleration(const Node& node, Braking braking) const {
    const std::uint32_t usual = DriveParameters::deceleration(node, braking);
    if constexpr (has_velocity) {
      if (mode_ != mode::velocity) return usual;
      if (braking == Braking::slow_down_ramp) return Velocity<DriveParameters, options>::ramps(node).deceleration;
      if (braking == Braking::quick_stop_ramp) return Velocity<DriveParameters, options>::quick_stop(node, usual);
    }
    return usual;
  }

  /// Takes a data record of interpolated position mode that has been written to 60C1h:01.
  template <class Node>
  AbortCode offer_set_point(const Node& node, std::int32_t position) requires(has_interpolation) {
    return interpolated_.offer(node, position);
  }
  /// A SYNC has been received. It begins a period of interpolated position mode if 1006h is that period.
  template <class Node>
  void on_sync(const Node& node) requires(has_interpolation) {
    bool is_clock = true;
    if constexpr (Device::dictionary.has(0x1006, 0)) {
      const std::uint32_t cycle = node.template get<object::CommunicationCyclePeriod>();
      is_clock = Duration{cycle} == interpolation_period<DriveParameters>(node);
    }
    interpolated_.on_sync(is_clock);
  }

  /// Processes the bits of the controlword that depend on the mode; returns whether a motion begins with them.
  template <class Node>
  bool take_bits(Node& node, AxisType& axis, std::uint16_t word, std::uint16_t rising, bool halted) {
    if constexpr (DriveParameters::has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) return take_set_point(node, axis, word, rising);
    }
    if constexpr (DriveParameters::has_mode(mode::homing)) {
      if (mode_ == mode::homing) return take_homing_bits(node, axis, word, rising, halted);
    }
    if constexpr (has_velocity || has_interpolation) bits_.word = word;
    return false;
  }

  /// Commands the axis before it takes a step.
  template <class Node, class Application>
  void operate(Node& node, AxisType& axis, Application& application, Duration span) {
    if constexpr (DriveParameters::has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) return operate_profile_position(axis);
    }
    if constexpr (DriveParameters::has_mode(mode::profile_velocity)) {
      if (mode_ == mode::profile_velocity) return operate_profile_velocity(node, axis);
    }
    if constexpr (DriveParameters::has_mode(mode::cyclic_synchronous_position)) {
      if (mode_ == mode::cyclic_synchronous_position) return follow_target(node, axis, span);
    }
    if constexpr (has_velocity) {
      if (mode_ == mode::velocity) return operate_velocity(node, axis);
    }
    if constexpr (has_interpolation) {
      if (mode_ == mode::interpolated_position) return interpolate(node, axis, span);
    }
    if constexpr (DriveParameters::has_mode(mode::cyclic_synchronous_velocity)) {
      if (mode_ == mode::cyclic_synchronous_velocity) return follow_velocity(node, axis, span);
    }
    if constexpr (has_torque) {
      if (controls_torque()) return operate_torque(node, axis, span);
    }
    if constexpr (DriveParameters::has_mode(mode::homing)) {
      if (homing_starts_) return start_homing(node, axis);
    }
    if constexpr (requires { application.operate(mode_); }) {
      if (mode_ != mode::none && !DriveParameters::has_mode(mode_)) application.operate(mode_);
    } else {
      static_assert(
          !DriveParameters::leaves_modes,
          "6060h accepts modes that the profile does not have: the application of the drive needs operate(mode)");
    }
  }

  /// Returns bits 12 and 13 of the statusword in Operation Enabled. `operates`: not while it is halted or left.
  [[nodiscard]] std::uint16_t status_bits(const Conditions<Device, options>& conditions, bool operates) const {
    const auto bit_if = [](bool there, std::uint16_t bit) { return there ? bit : std::uint16_t{0}; };
    switch (mode_) {
      case mode::profile_position:
        return static_cast<std::uint16_t>(bit_if(set_points_.acknowledge(), statusword::set_point_acknowledge) |
                                          bit_if(conditions.following_error(), statusword::following_error));
      case mode::profile_velocity:
        return bit_if(options.tells_speed_is_zero && conditions.resting(), statusword::speed_is_zero);
      case mode::homing:
        return static_cast<std::uint16_t>(bit_if(homing_.attained(), statusword::homing_attained) |
                                          bit_if(homing_.failed(), statusword::homing_error));
      case mode::cyclic_synchronous_position:
        return static_cast<std::uint16_t>(bit_if(operates, statusword::follows_command) |
                                          bit_if(conditions.following_error(), statusword::following_error));
      default: break;
    }
    if constexpr (has_interpolation) {
      if (mode_ == mode::interpolated_position)
        return bit_if(operates && interpolated_.active(), statusword::interpolates);
    }
    if constexpr (DriveParameters::has_mode(mode::cyclic_synchronous_velocity) ||
                  DriveParameters::has_mode(mode::cyclic_synchronous_torque)) {
      if (mode_ == mode::cyclic_synchronous_velocity || mode_ == mode::cyclic_synchronous_torque)
        return bit_if(operates, statusword::follows_command);
    }
    return 0;
  }

  /// Continues a homing after a step of the axis.
  void step_homing(AxisType& axis) {
    if constexpr (DriveParameters::has_mode(mode::homing)) {
      if (homing_.running()) homing_.step(axis);
    }
  }

  /// Ends the present set-point when the axis is at standstill.
  void finish_set_point(const AxisType& axis) {
    if (set_points_.active() && !set_points_.starts() && !axis.moving()) set_points_.reached();
  }

  /// Stops an axis that moves towards a limit.
  template <class Node>
  void keep_limits(const Node& node, AxisType& axis) {
    const std::int32_t velocity = controls_torque() ? axis.velocity() : axis.velocity_demand();
    if (homing_.running()) return;
    const bool at_switch = limit_switch_blocks(axis.inputs(), velocity);
    if (at_switch) set_points_.clear();
    if (at_switch ||
        (keeps_software_limits() && DriveParameters::software_limit_blocks(node, axis.position_demand(), velocity))) {
      stop(axis, DriveParameters::quick_stop_deceleration(node), Braking::quick_stop_ramp);
    }
  }

 private:
  static constexpr bool has_period = DriveParameters::template has<object::InterpolationTimeUnits>;
  static constexpr bool interpolates_targets =
      has_period && (DriveParameters::has_mode(mode::cyclic_synchronous_position) ||
                     DriveParameters::has_mode(mode::cyclic_synchronous_velocity));

  /// Stands for a part that the drive does not have.
  struct Absent {
    static constexpr void clear() {}
    static constexpr bool active() { return false; }
    static constexpr bool at_rest() { return true; }
    static constexpr std::int16_t demand() { return 0; }
    static constexpr bool reached() { return true; }
    static constexpr bool limited() { return false; }
  };
  struct NoTorque : Absent {};
  struct NoInterpolation : Absent {};
  struct NoMotion : Absent {};
  /// Of the controlword, for the modes that depend on its bits at each step.
  struct Bits {
    std::uint16_t word = 0;
    bool locked = false;  ///< the ramp of velocity mode was locked at the last step
  };
  struct NoBits {};

  /// Whether the mode has no target position that is clamped to the software limits.
  [[nodiscard]] bool keeps_software_limits() const {
    return mode_ == mode::profile_velocity || controls_torque() ||
           (DriveParameters::has_mode(mode::cyclic_synchronous_velocity) && mode_ == mode::cyclic_synchronous_velocity);
  }

  // Cyclic synchronous position and interpolated position

  template <class Node>
  void follow_target(const Node& node, AxisType& axis, [[maybe_unused]] Duration span) {
    const auto offset = static_cast<std::uint32_t>(DriveParameters::template value<object::PositionOffset>(node, 0));
    const auto target = static_cast<std::int32_t>(
        static_cast<std::uint32_t>(DriveParameters::template value<object::TargetPosition>(node, 0)) + offset);
    follow(node, axis, on_the_way(node, target, axis.position_demand(), span));
  }

  template <class Node>
  void interpolate(const Node& node, AxisType& axis, Duration span) {
    const bool enable = (bits_.word & controlword::interpolate) != 0;
    const std::int32_t position = interpolated_.step(node, enable, axis.position_demand(), span);
    if (enable) follow(node, axis, position);
  }

  /// Returns the value at the end of a step on the way from the present value to a target, which takes the time 60C2h.
  template <class Node>
  [[nodiscard]] std::int32_t on_the_way([[maybe_unused]] const Node& node, std::int32_t target,
                                        [[maybe_unused]] std::int32_t present, [[maybe_unused]] Duration span) {
    if constexpr (interpolates_targets) {
      const Duration period = interpolation_period<DriveParameters>(node);
      if (!motion_.begun()) {
        motion_.begin(present, target);
      } else if (motion_.target() != target) {
        motion_.begin(motion_.value(period), target);
      }
      motion_.step(span, period);
      return motion_.value(period);
    } else {
      return target;
    }
  }

  template <class Node>
  void follow(const Node& node, AxisType& axis, std::int32_t target) {
    const std::int32_t allowed = DriveParameters::within_software_limits(node, target);
    const std::int32_t demand = axis.position_demand();
    const std::int32_t direction = allowed == demand ? 0 : allowed > demand ? 1 : -1;
    if (!limit_switch_blocks(axis.inputs(), direction)) axis.follow(allowed);
  }

  // Profile position

  template <class Node>
  bool take_set_point(Node& node, const AxisType& axis, std::uint16_t word, std::uint16_t rising) {
    if ((word & controlword::new_set_point) == 0) set_points_.release();
    if ((rising & controlword::new_set_point) == 0) return false;
    auto target = static_cast<std::uint32_t>(DriveParameters::template value<object::TargetPosition>(node, 0));
    if ((word & controlword::relative) != 0) {
      target += static_cast<std::uint32_t>(set_points_.active() ? set_points_.last_target() : axis.position_demand());
    }
    set_points_.offer({DriveParameters::within_software_limits(node, static_cast<std::int32_t>(target)),
                       DriveParameters::profile(node)},
                      (word & controlword::change_immediately) != 0);
    return true;
  }

  void operate_profile_position(AxisType& axis) {
    const SetPoint* const set_point = set_points_.to_start();
    if (set_point == nullptr) return;
    const std::int32_t direction = axis.position_demand() < set_point->target ? 1 : -1;
    if (limit_switch_blocks(axis.inputs(), direction)) return set_points_.clear();
    axis.move_to(set_point->target, set_point->profile);
  }

  // Profile velocity

  template <class Node>
  void operate_profile_velocity(Node& node, AxisType& axis) {
    const Profile ramps = DriveParameters::profile(node);
    run_at(axis, velocity_target(node, axis, DriveParameters::template value<object::TargetVelocity>(node, 0)), ramps);
  }

  /// Passes a command to the axis if it differs from the last one.
  void run_at(AxisType& axis, std::int32_t wanted, const Profile& ramps) {
    if (velocity_told_ && wanted == told_velocity_ && ramps == told_ramps_) return;
    velocity_told_ = true;
    told_velocity_ = wanted;
    told_ramps_ = ramps;
    axis.run_at(wanted, ramps);
  }

  /// Returns a velocity limited to 607Fh; 0 if a limit switch or software limit blocks the motion.
  template <class Node>
  [[nodiscard]] static std::int32_t velocity_target(const Node& node, const AxisType& axis, std::int32_t wanted) {
    const std::uint32_t allowed =
        std::min<std::uint32_t>(DriveParameters::at_most_allowed(node, 0x7FFF'FFFF), 0x7FFF'FFFF);
    const auto most = static_cast<std::int32_t>(allowed);
    wanted = std::clamp(wanted, -most, most);
    return limit_switch_blocks(axis.inputs(), wanted) ||
                   DriveParameters::software_limit_blocks(node, axis.position_demand(), wanted)
               ? 0
               : wanted;
  }

  // Cyclic synchronous velocity: the ramps are those of the master.

  template <class Node>
  void follow_velocity(const Node& node, AxisType& axis, Duration span) {
    const std::int64_t sum = std::int64_t{DriveParameters::template value<object::TargetVelocity>(node, 0)} +
                             DriveParameters::template value<object::VelocityOffset>(node, 0);
    const auto target = static_cast<std::int32_t>(std::clamp<std::int64_t>(sum, -0x7FFF'FFFF, 0x7FFF'FFFF));
    run_at(axis, velocity_target(node, axis, on_the_way(node, target, axis.velocity_demand(), span)), Profile{});
  }

  // Velocity

  template <class Node>
  void operate_velocity(const Node& node, AxisType& axis) {
    using Value = Velocity<DriveParameters, options>;
    std::int32_t wanted = (bits_.word & controlword::use_reference) != 0 ? Value::target(node) : 0;
    if ((bits_.word & controlword::unlock_ramp) == 0) wanted = bits_.locked ? told_velocity_ : axis.velocity_demand();
    bits_.locked = (bits_.word & controlword::unlock_ramp) == 0;
    if ((bits_.word & controlword::enable_ramp) == 0 || limit_switch_blocks(axis.inputs(), wanted)) wanted = 0;
    run_at(axis, wanted, Value::ramps(node));
  }

  // Torque

  template <class Node>
  void operate_torque(const Node& node, AxisType& axis, Duration span) {
    if (mode_ == mode::profile_torque) {
      torque_.approach(node, span);
    } else {
      torque_.follow(node);
    }
    const std::int32_t direction = torque_.demand();
    if (limit_switch_blocks(axis.inputs(), direction) ||
        DriveParameters::software_limit_blocks(node, axis.position(), direction)) {
      torque_.block();
      stop(axis, DriveParameters::quick_stop_deceleration(node), Braking::quick_stop_ramp);
    } else {
      axis.apply_torque(torque_.demand());
    }
  }

  // Homing

  template <class Node>
  bool take_homing_bits(Node& node, AxisType& axis, std::uint16_t word, std::uint16_t rising, bool halted) {
    if ((rising & controlword::start_homing) != 0 && !halted && (word & controlword::halt) == 0) {
      if constexpr (options.target_reached_until_motion) {
        homing_starts_ = true;
      } else {
        start_homing(node, axis);
      }
      return true;
    }
    if ((word & controlword::start_homing) == 0 && homing_.running()) {
      homing_.interrupt();
      axis.stop(DriveParameters::profile(node).deceleration);
    }
    return false;
  }

  template <class Node>
  void start_homing(const Node& node, AxisType& axis) {
    const auto acceleration =
        DriveParameters::template value<object::ProfileAcceleration>(node, options.homing_acceleration);
    homing_.start(axis,
                  {.method = DriveParameters::template value<object::HomingMethodCode>(node, 0),
                   .fast = DriveParameters::template value<object::SpeedToSwitch>(node, 0),
                   .slow = DriveParameters::template value<object::SpeedToZero>(node, 0),
                   .acceleration = DriveParameters::template value<object::HomingAcceleration>(node, acceleration),
                   .home_offset = DriveParameters::template value<object::HomeOffset>(node, 0)});
    homing_starts_ = false;
  }

  std::int8_t mode_ = options.initial_mode;
  std::int8_t selected_ = options.initial_mode;
  bool homing_starts_ = false;  ///< with the next step
  bool velocity_told_ = false;
  std::int32_t told_velocity_ = 0;
  Profile told_ramps_{};
  SetPoints set_points_{};
  Homing homing_{};
  [[no_unique_address]] std::conditional_t<has_torque, Torque<DriveParameters>, NoTorque> torque_{};
  [[no_unique_address]] std::conditional_t<has_interpolation, InterpolatedPosition<DriveParameters, options>,
                                           NoInterpolation>
      interpolated_{};
  [[no_unique_address]] std::conditional_t<interpolates_targets, LinearMotion, NoMotion> motion_{};
  [[no_unique_address]] std::conditional_t<has_velocity || has_interpolation, Bits, NoBits> bits_{};
};

}  // namespace canopen::cia402
