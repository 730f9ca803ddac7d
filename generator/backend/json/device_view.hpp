/// The JSON view of a device, which `edsc dump` prints. Its schema is in docs/schema/.
#pragma once

#include <nlohmann/json.hpp>

#include "backend/identifiers.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The device itself: objects, entries, values and PDO layouts, free of any target language.
[[nodiscard]] nlohmann::ordered_json device_view(const Device& device, const Identifiers& names);

/// In the view of a DCF: `default_value` becomes the DefaultValue, and `parameter_value` the ParameterValue, if
/// present. Values that CiA 301 fixes remain `default_value`.
void separate_configured_values(const DataSheet& sheet, const Device& device, nlohmann::ordered_json& view);

}  // namespace edsc
