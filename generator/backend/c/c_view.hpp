/// The view of the C templates.
#pragma once

#include <nlohmann/json.hpp>

#include "backend/cpp/cpp_names.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// All data of a device that templates/targets/c uses: entries with their names in C, types and constants; PDOs with
/// the place of each object in the frame.
[[nodiscard]] nlohmann::ordered_json c_view(const NamedDevice& named, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
