/// Default value and parameter value of the entries of a DCF.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// In the view of a DCF: `default_value` becomes the DefaultValue, and `parameter_value` the ParameterValue, if
/// present. Values that CiA 301 fixes remain `default_value`.
void separate_configured_values(const DataSheet& sheet, const Device& device, nlohmann::ordered_json& view);

}  // namespace edsc
