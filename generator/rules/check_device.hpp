/// What is wrong with a resolved device.
#pragma once

#include "device/device.hpp"
#include "device/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Runs all rules over the device and the data sheet that it was made of. PDOs with an error are marked as broken;
/// limits that cannot hold are dropped, with a warning.
void check_device(Device& device, const DataSheet& sheet, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
