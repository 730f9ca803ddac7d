/// Drives (CiA 402): whether a test may write their parameters and send them process data.
#pragma once

#include <string>

#include "device/device.hpp"
#include "online/identity.hpp"
#include "online/sdo_access.hpp"

namespace edsc::conform {

/// Returns why the device may move when a test writes to it. Empty if neither 1000h nor the EDS describes a drive, or
/// if the statusword 6041h of each axis reports that the axis is not enabled (CiA 402-2, statusword).
[[nodiscard]] std::string why_drive_may_move(SdoAccess& node, const Device& sheet, const Identity& found);

}  // namespace edsc::conform
