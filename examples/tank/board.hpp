/// The inputs and outputs of the tank: in place of the registers of a board.
#pragma once

#include <cstdint>

struct Board {
  std::uint8_t switches = 5;  ///< of the node-ID, in binary
  std::uint16_t sensor = 0;   ///< mm
  bool run_led = false;
  bool error_led = false;
  bool measures = false;

  void start_measuring() { measures = true; }
  [[nodiscard]] std::uint16_t level() const { return measures ? sensor : std::uint16_t{0}; }
  void set_leds(bool run, bool error) {
    run_led = run;
    error_led = error;
  }
};

inline Board board;
