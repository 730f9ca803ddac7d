/// The two values of an entry of a DCF.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// In the view of a DCF's device: `default_value` becomes the DefaultValue, and `parameter_value` is the ParameterValue
/// where there is one. What CiA 301 gives the device, whatever the file says, stays its default.
void separate_configured_values(const DataSheet& sheet, const Device& device, nlohmann::ordered_json& view);

}  // namespace edsc
