/// Bit rates by their numbers in LSS, and what differs from one LSS slave to another (CiA 305).
#pragma once

#include <cstdint>

namespace canopen {

namespace lss {

/// Bit rates in kbit/s by the index of table 0; 0: reserved.
inline constexpr std::uint16_t bit_rates[] = {1000, 800, 500, 250, 125, 0, 50, 20, 10};
/// The index of table 0 that makes a device find out the bit rate.
inline constexpr std::uint8_t automatic_bit_rate = 9;
/// All of `bit_rates`, one bit an index.
inline constexpr std::uint16_t all_bit_rates = 0x01DF;

}  // namespace lss

/// What differs from device to device. The defaults are those of CiA 305.
struct LssOptions {
  /// Bit rates of table 0 that the device has, one bit an index; bit 9 is automatic detection. 0: its bit rate is
  /// fixed.
  std::uint16_t bit_rates = lss::all_bit_rates;
  /// Bit rates of the manufacturer's own, tables 128..255, are put before the node.
  bool manufacturer_bit_timing = false;
  /// Configure node-ID accepts 255, which takes the node-ID away.
  bool unconfigurable = true;
  bool fastscan = true;
  bool served_in_stopped = true;
  bool served_in_operational = false;
};

}  // namespace canopen
