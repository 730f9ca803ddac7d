/// The objects that show where the axis is: demand and actual values, following error, inputs (CiA 402-2).
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/profile/cia402_axis.hpp"
#include "canopen/profile/cia402_objects.hpp"
#include "canopen/profile/cia402_options.hpp"
#include "canopen/profile/cia402_parameters.hpp"
#include "canopen/profile/cia402_velocity.hpp"

namespace canopen::cia402 {

template <class Device, Options options>
class ActualValues {
 public:
  /// Sets the objects; while the axis moves only at intervals, unless `at_once`.
  template <class Node, Axis AxisType>
  void publish(Node& node, const AxisType& axis, TimePoint now, bool at_once) {
    using DriveParameters = Parameters<Device, options>;
    if (!at_once && axis.moving() && now - published_ < Duration{options.actual_values}) return;
    published_ = now;
    DriveParameters::template set<object::PositionDemandValue>(node, axis.position_demand());
    DriveParameters::template set<object::PositionActualValue>(node, axis.position());
    DriveParameters::template set<object::VelocityDemandValue>(node, axis.velocity_demand());
    DriveParameters::template set<object::VelocityActualValue>(node, axis.velocity());
    DriveParameters::template set<object::FollowingErrorActualValue>(
        node, static_cast<std::int32_t>(static_cast<std::uint32_t>(axis.position_demand()) -
                                        static_cast<std::uint32_t>(axis.position())));
    DriveParameters::template set<object::DigitalInputs>(node, axis.inputs());
    if constexpr (TorqueAxis<AxisType>) DriveParameters::template set<object::TorqueActualValue>(node, axis.torque());
    if constexpr (DriveParameters::has_mode(mode::velocity)) {
      using Value = Velocity<DriveParameters, options>;
      DriveParameters::template set<object::VelocityDemand>(node, Value::from_axis(node, axis.velocity_demand()));
      DriveParameters::template set<object::VelocityActual>(node, Value::from_axis(node, axis.velocity()));
    }
  }

 private:
  TimePoint published_{};  ///< when the objects were set last
};

}  // namespace canopen::cia402
