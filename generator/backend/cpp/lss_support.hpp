/// Whether a device supports LSS, and its bit rates: for the generated code and for devices that are loaded at run
/// time.
#pragma once

#include <algorithm>
#include <canopen/lss/lss_options.hpp>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Whether the EDS or the options state that the device supports LSS.
[[nodiscard]] inline bool has_lss(const Device& device, const Options& options) {
  return options.lss || device.information.capabilities.lss_supported.value_or(false);
}

/// Returns the bit rates of the EDS in the format of canopen::LssOptions::bit_rates.
[[nodiscard]] inline std::uint16_t lss_bit_rates(const Capabilities& capabilities) {
  unsigned mask = 0;
  for (std::size_t i = 0; i < std::size(canopen::lss::bit_rates); ++i) {
    const std::uint16_t rate = canopen::lss::bit_rates[i];
    if (rate != 0 && std::ranges::find(capabilities.baud_rates, rate) != capabilities.baud_rates.end()) mask |= 1u << i;
  }
  return static_cast<std::uint16_t>(mask);
}

}  // namespace edsc
