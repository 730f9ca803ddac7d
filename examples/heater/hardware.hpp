/// The inputs of the heater: in place of the registers of a board.
#pragma once

#include <cstdint>

struct Hardware {
  bool door_open = false;
  std::int16_t sensor = 215;  ///< 0.1 °C
  [[nodiscard]] std::int16_t temperature() const { return sensor; }
};

inline Hardware hardware;
