/// Data sheet -> device: types, values, compact forms, missing keys, names and default PDOs.
#pragma once

#include "device/device.hpp"
#include "device/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct ResolveSettings {
  std::string name;                     ///< C++ namespace; from the file's name when empty
  std::optional<std::uint8_t> node_id;  ///< turns formulas into numbers
};

/// Resolves a data sheet. What cannot be resolved is reported as an error and left out; what has to be guessed is a
/// warning that says what was assumed.
[[nodiscard]] Device resolve_device(const DataSheet& sheet, const Options& options, const ResolveSettings& settings,
                                    Diagnostics& diagnostics);

}  // namespace edsc
