/// The inputs of the heater: in place of the registers of a board.
#pragma once

#include <heater/device.hpp>

using namespace canopen::literals;

struct Hardware {
  bool door_open = false;
  heater::od::temperature::type sensor = 21.5_degC;
};

inline Hardware hardware;
