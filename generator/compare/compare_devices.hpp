/// Two versions of a device, compared by what they mean.
#pragma once

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

/// The device's own data, then objects and entries ascending, then PDOs.
[[nodiscard]] Changes compare_devices(const Device& before, const Device& after);

}  // namespace edsc
