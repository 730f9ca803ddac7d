/// What the pump does with its objects.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <pump/device.hpp>

namespace od = pump::od;

struct Pump {
  /// An SDO write or RPDO 1 has set a new speed: TPDO 1 is sent with the pressure.
  void written(od::speed_setpoint, std::uint16_t speed, auto& node) {
    node.set(od::pressure{}, static_cast<std::uint16_t>(speed / 4));
  }
};

/// The composition of the device, for its program and its conformance test.
using PumpParts = canopen::Composition<pump::Device, Pump>;
