/// The values that a DCF configures: the entries with a ParameterValue, as SDO download data.
#pragma once

#include <string>
#include <vector>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct ConfiguredValue {
  const Entry* entry = nullptr;
  std::string data;      ///< low byte first
  bool differs = false;  ///< from the default value
  Position position;     ///< the value
};

/// The writable entries that have a ParameterValue, ascending, except DOMAINs. `device` is that of `sheet`, with the
/// node-ID. A formula without node-ID and an invalid value are reported and ignored.
[[nodiscard]] std::vector<ConfiguredValue> configured_values(const DataSheet& sheet, const Device& device,
                                                             Diagnostics& diagnostics);

}  // namespace edsc
