/// Modes of operation of a drive: profile position, profile velocity, homing, cyclic synchronous position (CiA 402-2).
#pragma once

#include <algorithm>
#include <cstdint>

#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_conditions.hpp"
#include "canopen/profile/cia402_homing.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"
#include "canopen/profile/cia402_set_points.hpp"
#include "canopen/profile/cia402_words.hpp"

namespace canopen::cia402 {

/// The present mode, its bits of the controlword, and what it commands the axis. Device control decides when a mode
/// operates. Modes that are not in `options.modes` are not in the image.
template <class Device, Axis A, Options options>
class Modes {
 public:
  /// Whether 6060h accepts this value.
  [[nodiscard]] static constexpr bool supports(std::int8_t wanted) {
    return wanted == mode::none || P::has_mode(wanted) || (wanted < 0 && wanted >= options.lowest_mode);
  }

  [[nodiscard]] std::int8_t present() const { return mode_; }
  [[nodiscard]] const Homing& homing() const { return homing_; }
  [[nodiscard]] const SetPoints& set_points() const { return set_points_; }

  /// Sets the mode of a drive without 6060h.
  void select(std::int8_t wanted) { selected_ = wanted; }

  /// Returns the mode that is requested.
  template <class Node>
  [[nodiscard]] std::int8_t wanted(const Node& node) const {
    return P::template value<object::ModesOfOperation>(node, selected_);
  }

  /// Power-on, or a reset that restarts the drive.
  void restart() {
    set_points_.clear();
    homing_.interrupt();
    mode_ = options.initial_mode;
  }

  /// Changes the mode of an axis at standstill.
  void change(std::int8_t wanted) {
    restart();
    mode_ = wanted;
    velocity_told_ = false;
  }

  /// The drive enters Operation Enabled.
  void begin() { velocity_told_ = false; }

  /// The drive leaves Operation Enabled.
  void end() {
    set_points_.clear();
    interrupt_homing();
    homing_starts_ = false;
  }

  void interrupt_homing() { homing_.interrupt_running(); }

  /// Continues the motion that was stopped.
  void resume() {
    set_points_.start_again();
    velocity_told_ = false;
  }

  /// Processes the bits of the controlword that depend on the mode; returns whether a motion begins with them.
  template <class Node>
  bool take_bits(Node& node, A& axis, std::uint16_t word, std::uint16_t rising, bool halted) {
    if constexpr (P::has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) return take_set_point(node, axis, word, rising);
    }
    if constexpr (P::has_mode(mode::homing)) {
      if (mode_ == mode::homing) return take_homing_bits(node, axis, word, rising, halted);
    }
    return false;
  }

  /// Commands the axis before it takes a step.
  template <class Node, class Application>
  void operate(Node& node, A& axis, Application& application) {
    if constexpr (P::has_mode(mode::profile_position)) {
      if (mode_ == mode::profile_position) return operate_profile_position(axis);
    }
    if constexpr (P::has_mode(mode::profile_velocity)) {
      if (mode_ == mode::profile_velocity) return operate_profile_velocity(node, axis);
    }
    if constexpr (P::has_mode(mode::cyclic_synchronous_position)) {
      if (mode_ == mode::cyclic_synchronous_position) return follow_target(node, axis);
    }
    if constexpr (P::has_mode(mode::homing)) {
      if (homing_starts_) return start_homing(node, axis);
    }
    if constexpr (requires { application.operate(mode_); }) {
      if (mode_ < 0) application.operate(mode_);
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
      default: return 0;
    }
  }

  /// Continues a homing after a step of the axis.
  void step_homing(A& axis) {
    if constexpr (P::has_mode(mode::homing)) {
      if (homing_.running()) homing_.step(axis);
    }
  }

  /// Ends the present set-point when the axis is at standstill.
  void finish_set_point(const A& axis) {
    if (set_points_.active() && !set_points_.starts() && !axis.moving()) set_points_.reached();
  }

  /// Stops an axis that moves towards a limit.
  template <class Node>
  void keep_limits(const Node& node, A& axis) {
    const std::int32_t velocity = axis.velocity_demand();
    if (homing_.running()) return;
    const bool at_switch = limit_switch_blocks(axis.inputs(), velocity);
    if (at_switch) set_points_.clear();
    if (at_switch ||
        (mode_ == mode::profile_velocity && P::software_limit_blocks(node, axis.position_demand(), velocity))) {
      axis.stop(P::quick_stop_deceleration(node));
    }
  }

 private:
  using P = Parameters<Device, options>;

  // Cyclic synchronous position

  template <class Node>
  void follow_target(const Node& node, A& axis) {
    const auto offset = static_cast<std::uint32_t>(P::template value<object::PositionOffset>(node, 0));
    const auto target = static_cast<std::uint32_t>(P::template value<object::TargetPosition>(node, 0)) + offset;
    const std::int32_t allowed = P::within_software_limits(node, static_cast<std::int32_t>(target));
    const std::int32_t demand = axis.position_demand();
    const std::int32_t direction = allowed == demand ? 0 : allowed > demand ? 1 : -1;
    if (!limit_switch_blocks(axis.inputs(), direction)) axis.follow(allowed);
  }

  // Profile position

  template <class Node>
  bool take_set_point(Node& node, const A& axis, std::uint16_t word, std::uint16_t rising) {
    if ((word & controlword::new_set_point) == 0) set_points_.release();
    if ((rising & controlword::new_set_point) == 0) return false;
    auto target = static_cast<std::uint32_t>(P::template value<object::TargetPosition>(node, 0));
    if ((word & controlword::relative) != 0) {
      target += static_cast<std::uint32_t>(set_points_.active() ? set_points_.last_target() : axis.position_demand());
    }
    set_points_.offer({P::within_software_limits(node, static_cast<std::int32_t>(target)), P::profile(node)},
                      (word & controlword::change_immediately) != 0);
    return true;
  }

  void operate_profile_position(A& axis) {
    const SetPoint* const set_point = set_points_.to_start();
    if (set_point == nullptr) return;
    const std::int32_t direction = axis.position_demand() < set_point->target ? 1 : -1;
    if (limit_switch_blocks(axis.inputs(), direction)) return set_points_.clear();
    axis.move_to(set_point->target, set_point->profile);
  }

  // Profile velocity

  template <class Node>
  void operate_profile_velocity(Node& node, A& axis) {
    const Profile ramps = P::profile(node);
    const std::int32_t wanted = velocity_target(node, axis);
    if (velocity_told_ && wanted == told_velocity_ && ramps == told_ramps_) return;
    velocity_told_ = true;
    told_velocity_ = wanted;
    told_ramps_ = ramps;
    axis.run_at(wanted, ramps);
  }

  /// Returns 60FFh limited to 607Fh; 0 if a limit switch or software limit blocks the motion.
  template <class Node>
  [[nodiscard]] static std::int32_t velocity_target(const Node& node, const A& axis) {
    std::int32_t wanted = P::template value<object::TargetVelocity>(node, 0);
    const std::uint32_t allowed = std::min<std::uint32_t>(P::at_most_allowed(node, 0x7FFF'FFFF), 0x7FFF'FFFF);
    const auto most = static_cast<std::int32_t>(allowed);
    wanted = std::clamp(wanted, -most, most);
    return limit_switch_blocks(axis.inputs(), wanted) || P::software_limit_blocks(node, axis.position_demand(), wanted)
               ? 0
               : wanted;
  }

  // Homing

  template <class Node>
  bool take_homing_bits(Node& node, A& axis, std::uint16_t word, std::uint16_t rising, bool halted) {
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
      axis.stop(P::profile(node).deceleration);
    }
    return false;
  }

  template <class Node>
  void start_homing(const Node& node, A& axis) {
    const auto acceleration = P::template value<object::ProfileAcceleration>(node, options.homing_acceleration);
    homing_.start(axis, {.method = P::template value<object::HomingMethodCode>(node, 0),
                         .fast = P::template value<object::SpeedToSwitch>(node, 0),
                         .slow = P::template value<object::SpeedToZero>(node, 0),
                         .acceleration = P::template value<object::HomingAcceleration>(node, acceleration),
                         .home_offset = P::template value<object::HomeOffset>(node, 0)});
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
};

}  // namespace canopen::cia402
