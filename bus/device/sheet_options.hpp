/// The options of a device whose EDS is loaded at run time: what the generated code states as constants.
#pragma once

#include <canopen/lss/lss_options.hpp>
#include <canopen/od/device_options.hpp>
#include <cstdint>
#include <optional>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Returns the deviations from CiA 301 that an options file states.
[[nodiscard]] canopen::DeviceOptions device_options(const Options& options);

/// Returns how LSS configures a device; empty: it does not.
[[nodiscard]] std::optional<canopen::LssOptions> lss_options(const Device& device, const Options& options);

/// Returns whether 1010h stores an entry, by the options.
[[nodiscard]] canopen::Storing storing_of(const Options& options, std::uint16_t index, std::uint8_t sub_index);

}  // namespace edsc
