/// Drives (CiA 402): whether a test may write their parameters and send them process data.
#pragma once

#include <string>

#include "device/device.hpp"
#include "online/identity.hpp"
#include "online/sdo_access.hpp"

namespace edsc::conform {

/// Why the device may move when a test writes to it. Empty for a device that is not a drive, in 1000h and in the EDS, and for
/// a drive whose axes all say in the statusword 6041h that they are not enabled (CiA 402-2, statusword).
[[nodiscard]] std::string why_drive_may_move(SdoAccess& node, const Device& sheet, const Identity& found);

}  // namespace edsc::conform
