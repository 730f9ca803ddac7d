/// What a data sheet leaves open and CiA 301 does not.
#pragma once

#include <cstdint>

#include "device/device.hpp"

namespace edsc {

/// The transmission type of a PDO whose sheet has none: event-driven, as the device profiles have it. CiA 301 has no
/// default.
inline constexpr std::uint8_t default_transmission_type = 255;

/// Gives the communication profile of a device the values that it starts with by CiA 301: those that the standard fixes,
/// whatever the file says, and those that it implies, where the file has none. A value that comes from the standard names
/// its clause; what differs from the file, or is missing there, is reported.
void complete_device(Device& device, Diagnostics& diagnostics);

}  // namespace edsc
