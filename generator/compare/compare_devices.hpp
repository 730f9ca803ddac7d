/// Compares two versions of a device by meaning.
#pragma once

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

/// Compares device data, then objects and entries ascending, then PDOs.
[[nodiscard]] Changes compare_devices(const Device& before, const Device& after);

}  // namespace edsc
