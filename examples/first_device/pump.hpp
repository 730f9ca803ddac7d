/// What the pump does with its objects.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <pump/device.hpp>

namespace od = pump::od;

/// In place of a sensor: this pump has 1 mbar for 4 rpm.
inline od::pressure::type pressure_at(od::speed_setpoint::type speed) {
  const auto rpm = speed.count<canopen::unit::revolution_per_minute>();
  return od::pressure::type{canopen::raw(static_cast<std::uint16_t>(rpm / 4))};
}

struct Pump {
  /// An SDO write or RPDO 1 has set a new speed: TPDO 1 is sent with the pressure.
  void written(od::speed_setpoint, od::speed_setpoint::type speed, auto& node) {
    node.set(od::pressure{}, pressure_at(speed));
  }
};

/// The composition of the device, for its program and its conformance test.
using PumpParts = canopen::Composition<pump::Device, Pump>;
