/// What is wrong with a resolved device.
#pragma once

#include "device/device.hpp"
#include "device/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Runs all rules over the device and the data sheet that it was made of. The device is the same before and after: what
/// cannot be used of a data sheet is left out, and reported, by resolve_device().
void check_device(const Device& device, const DataSheet& sheet, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
