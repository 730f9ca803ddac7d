/// Resolves a data sheet to a device: types, values, compact forms, missing keys and default PDOs.
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Resolves a data sheet, and formulas if the node-ID is known. What cannot be resolved is reported as an error and
/// skipped; each assumption is reported as a warning.
[[nodiscard]] Device resolve_device(const DataSheet& sheet, const Options& options,
                                    const std::optional<std::uint8_t>& node_id, Diagnostics& diagnostics);

}  // namespace edsc
