/// The inputs and outputs of the tank: in place of the registers of a board.
#pragma once

#include <cstdint>
#include <tank/device.hpp>

struct Board {
  std::uint8_t switches = 5;  ///< of the node-ID, in binary
  tank::od::level::type sensor{};
  bool run_led = false;
  bool error_led = false;
  bool measures = false;

  void start_measuring() { measures = true; }
  [[nodiscard]] tank::od::level::type level() const { return measures ? sensor : tank::od::level::type{}; }
  void set_leds(bool run, bool error) {
    run_led = run;
    error_led = error;
  }
};

inline Board board;
