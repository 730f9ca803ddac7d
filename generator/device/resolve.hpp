/// Resolves a data sheet to a device: types, values, compact forms, missing keys, names and default PDOs.
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct ResolveSettings {
  std::string name;                     ///< C++ namespace; if empty, from the file name
  std::optional<std::uint8_t> node_id;  ///< to evaluate formulas
};

/// Resolves a data sheet. What cannot be resolved is reported as an error and left out; each assumption is reported as
/// a warning.
[[nodiscard]] Device resolve_device(const DataSheet& sheet, const Options& options, const ResolveSettings& settings,
                                    Diagnostics& diagnostics);

}  // namespace edsc
