/// Conditions of an axis that the statusword indicates: target reached, speed, following error, limits (CiA 402-2).
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"
#include "canopen/profile/cia402_window.hpp"

namespace canopen::cia402 {

/// What a drive does, as far as the conditions depend on it.
struct Activity {
  std::int8_t mode;
  bool stopping;   ///< halted, or in Quick Stop Active: bit 10 indicates standstill
  bool halted;     ///< the target velocity is 0
  bool homing;     ///< a homing is running
  bool set_point;  ///< a set-point is active
  bool at_target;  ///< the demand has reached the target of velocity or profile torque mode
};

/// Bits 10, 11, 12 (profile velocity) and 13 of the statusword.
template <class Device, Options options>
class Conditions {
 public:
  /// Forgets how long the conditions have been true.
  void clear() { at_target_ = at_speed_ = at_rest_ = off_course_ = {}; }

  /// Target reached; `expect_motion` resets it.
  [[nodiscard]] bool reached() const { return reached_; }
  void expect_motion() { reached_ = false; }

  [[nodiscard]] bool resting() const { return resting_; }                  ///< below 606Fh for 6070h
  [[nodiscard]] bool following_error() const { return following_error_; }  ///< 6065h exceeded for 6066h
  [[nodiscard]] bool software_limit() const { return software_limit_; }    ///< limited by 607Dh
  [[nodiscard]] bool limit_switch() const { return limit_switch_; }        ///< a limit switch is active

  /// Updates bits 10, 12 and 13 after a time span.
  template <class Node, Axis AxisType>
  void watch(const Node& node, const AxisType& axis, const Activity& activity, Duration span) {
    const std::uint32_t lag = distance(axis.position_demand(), axis.position());
    if constexpr (DriveParameters::template has<object::FollowingErrorWindow>) {
      const std::uint32_t window = DriveParameters::template value<object::FollowingErrorWindow>(node, 0);
      off_course_.step(window != 0 && window != 0xFFFF'FFFF && lag > window, span);
      following_error_ = off_course_.lasts(DriveParameters::template value<object::FollowingErrorTimeOut>(node, 0));
    }
    const std::uint32_t window = DriveParameters::template value<object::PositionWindow>(node, 0);
    at_target_.step(!axis.moving() && !activity.set_point && (window == 0xFFFF'FFFF || lag <= window), span);
    if constexpr (DriveParameters::has_mode(mode::profile_velocity)) {
      const std::int32_t velocity = axis.velocity();
      const std::int32_t wanted =
          activity.halted ? 0 : DriveParameters::template value<object::TargetVelocity>(node, 0);
      at_speed_.step(distance(velocity, wanted) <= DriveParameters::template value<object::VelocityWindow>(node, 0),
                     span);
      at_rest_.step(distance(velocity, 0) <= DriveParameters::template value<object::VelocityThreshold>(node, 0), span);
      resting_ = at_rest_.lasts(DriveParameters::template value<object::VelocityThresholdTime>(node, 0));
    }
    reached_ = is_reached(node, axis, activity);
  }

  /// Updates bit 11. During homing, limits are not indicated.
  template <class Node, Axis AxisType>
  void watch_limits(const Node& node, const AxisType& axis, bool homing) {
    limit_switch_ = !homing && (axis.inputs() & (input::negative_limit | input::positive_limit)) != 0;
    software_limit_ = !homing && (DriveParameters::software_limit_blocks(node, axis.position_demand(), 1) ||
                                  DriveParameters::software_limit_blocks(node, axis.position_demand(), -1));
  }

 private:
  using DriveParameters = Parameters<Device, options>;

  template <class Node, Axis AxisType>
  [[nodiscard]] bool is_reached(const Node& node, const AxisType& axis, const Activity& activity) const {
    if (activity.stopping) return !axis.moving();
    switch (activity.mode) {
      case mode::profile_velocity:
        return at_speed_.lasts(DriveParameters::template value<object::VelocityWindowTime>(node, 0));
      case mode::homing: return !activity.homing && !axis.moving();
      default: break;
    }
    if constexpr (DriveParameters::has_mode(mode::velocity) || DriveParameters::has_mode(mode::profile_torque)) {
      if (activity.mode == mode::velocity || activity.mode == mode::profile_torque) return activity.at_target;
    }
    if constexpr (DriveParameters::has_mode(mode::cyclic_synchronous_velocity) ||
                  DriveParameters::has_mode(mode::cyclic_synchronous_torque)) {
      if (activity.mode == mode::cyclic_synchronous_velocity || activity.mode == mode::cyclic_synchronous_torque)
        return false;
    }
    return at_target_.lasts(DriveParameters::template value<object::PositionWindowTime>(node, 0));
  }

  Lasting at_target_{};
  Lasting at_speed_{};
  Lasting at_rest_{};
  Lasting off_course_{};
  bool reached_ = true;
  bool resting_ = true;
  bool following_error_ = false;
  bool software_limit_ = false;
  bool limit_switch_ = false;
};

}  // namespace canopen::cia402
