/// LSS settings in flash, and the bit rate of the board's CAN controller.
#pragma once

#include <canopen/lss/lss_options.hpp>
#include <canopen/port/bit_timing.hpp>
#include <cstddef>
#include <cstdint>

#include "../firmware/lss_settings.hpp"
#include "can.hpp"

/// The port of canopen::configured_by_lss.
class CanLss : public LssSettings {
 public:
  constexpr CanLss(board::Flash& flash, board::Can& can) : LssSettings{flash}, can_{can} {}

  using LssSettings::accept;
  /// Accepts a bit rate that the clock of the controller allows.
  [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming timing) {
    const bool possible = canopen::bit_timing(board::can_clock, bit_rate(timing), board::Can::range).has_value();
    return possible ? canopen::lss::success : canopen::lss::bit_timing_not_supported;
  }

  /// Waiting frames are sent at the new bit rate.
  void stop_communication() { can_.stop(); }
  /// Uses 125 kbit/s if the controller cannot start with the bit rate.
  void start_communication(canopen::LssBitTiming timing) {
    if (!can_.start(board::can_clock, bit_rate(timing))) (void)can_.start(board::can_clock, 125'000);
  }

 private:
  /// In bit/s; 0: not a bit rate of table 0.
  [[nodiscard]] static std::uint32_t bit_rate(canopen::LssBitTiming timing) {
    constexpr std::size_t rates = sizeof canopen::lss::bit_rates / sizeof canopen::lss::bit_rates[0];
    return timing.table == 0 && timing.index < rates ? canopen::lss::bit_rates[timing.index] * 1000u : 0;
  }

  board::Can& can_;
};
