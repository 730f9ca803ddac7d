/// What a heater does with its objects.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <heater/device.hpp>

#include "hardware.hpp"

namespace od = heater::od;

struct Heater {
  canopen::AbortCode write(od::setpoint, std::int16_t) {
    return hardware.door_open ? canopen::AbortCode::device_state : canopen::ok;
  }
  void written(od::setpoint, std::int16_t setpoint, auto& node) {
    node.set(od::heating_power{}, static_cast<std::uint8_t>(setpoint / 10));
    if (setpoint > 900) node.emergency(0x4200, canopen::ErrorRegister::temperature);
  }
  std::int16_t read(od::temperature) { return hardware.temperature(); }
};

/// The composition of the device, for its program and its conformance test.
using HeaterParts = canopen::Composition<heater::Device, Heater>;
