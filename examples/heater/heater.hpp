/// What a heater does with its objects.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <heater/device.hpp>

#include "hardware.hpp"

namespace od = heater::od;
using namespace canopen::literals;

struct Heater {
  canopen::AbortCode write(od::setpoint, od::setpoint::type) {
    return hardware.door_open ? canopen::AbortCode::device_state : canopen::ok;
  }
  void written(od::setpoint, od::setpoint::type setpoint, auto& node) {
    const auto percent = setpoint.count<canopen::unit::degree_celsius>();  // 1 % for each °C
    node.set(od::heating_power{}, canopen::raw(static_cast<std::uint8_t>(percent)));
    if (setpoint > 90_degC) node.emergency(0x4200, canopen::ErrorRegister::temperature);
  }
  od::temperature::type read(od::temperature) { return hardware.sensor; }
};

/// The composition of the device, for its program and its conformance test.
using HeaterParts = canopen::Composition<heater::Device, Heater>;
