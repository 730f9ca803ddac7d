/// Checks a resolved device.
#pragma once

#include "backend/cpp/cpp_names.hpp"
#include "device/meaning/profiles.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Runs all rules over the device and its data sheet. Does not change the device: resolve_device() reports and leaves
/// out what cannot be used.
/// `user_profile` may be null.
void check_device(const NamedDevice& named, const DataSheet& sheet, const Options& options, Diagnostics& diagnostics,
                  const MeaningProfile* user_profile = nullptr);

}  // namespace edsc
