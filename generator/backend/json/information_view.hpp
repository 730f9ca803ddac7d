/// The part of the JSON view for sections other than objects.
#pragma once

#include <nlohmann/json.hpp>

#include "device/information.hpp"

namespace edsc {

/// Adds `file_info`, `device_info`, `commissioning`, `comments`, `tools`, `dynamic_channels` and `modules` to a view,
/// and `sections` if there are any.
void add_information(const Information& information, nlohmann::ordered_json& view);

}  // namespace edsc
