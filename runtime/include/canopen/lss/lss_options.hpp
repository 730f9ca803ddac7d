/// Bit rates by their LSS index, and options of LSS slaves (CiA 305).
#pragma once

#include <cstdint>

namespace canopen {

namespace lss {

/// Bit rates in kbit/s by the index of table 0; 0: reserved.
inline constexpr std::uint16_t bit_rates[] = {1000, 800, 500, 250, 125, 0, 50, 20, 10};
/// Index of table 0 for automatic bit rate detection.
inline constexpr std::uint8_t automatic_bit_rate = 9;
/// All of `bit_rates`, one bit per index.
inline constexpr std::uint16_t all_bit_rates = 0x01DF;

}  // namespace lss

/// Differences between devices. The defaults are those of CiA 305.
struct LssOptions {
  /// Supported bit rates of table 0, one bit per index; bit 9 is automatic detection. 0: the bit rate is fixed.
  std::uint16_t bit_rates = lss::all_bit_rates;
  /// Manufacturer-specific bit rates, tables 128..255, are passed to the node.
  bool manufacturer_bit_timing = false;
  /// Configure node-ID accepts 255, which removes the node-ID.
  bool unconfigurable = true;
  bool fastscan = true;
  bool served_in_stopped = true;
  bool served_in_operational = false;

  friend constexpr bool operator==(const LssOptions&, const LssOptions&) = default;
};

}  // namespace canopen
