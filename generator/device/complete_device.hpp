/// Values that an EDS does not state and CiA 301 does.
#pragma once

#include <cstdint>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// The transmission type of a PDO without one in the EDS: event-driven, as in the device profiles. CiA 301 does not
/// define a default value.
inline constexpr std::uint8_t default_transmission_type = 255;

/// Sets the default values of the communication profile that CiA 301 fixes, regardless of the file, and those that it
/// implies and the file does not state. Each such value records its clause; differences from the file and missing
/// values are reported.
void complete_device(Device& device, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
