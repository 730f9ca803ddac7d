/// What is wrong with a resolved device.
#pragma once

#include "device/device.hpp"

namespace edsc {

/// Runs all rules over the device. PDOs with an error are marked as broken; limits that cannot hold are dropped, with a
/// warning.
void check_device(Device& device, Diagnostics& diagnostics);

}  // namespace edsc
