/// The JSON view of a device, which `edsc dump` prints and the templates use. Its schema is in docs/schema/.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// The device itself: objects, entries, values and PDO layouts, free of any target language.
[[nodiscard]] nlohmann::ordered_json device_view(const Device& device);

/// The additional view for the C++ templates: declarations and tables as lines of C++.
[[nodiscard]] nlohmann::ordered_json cpp_view(const Device& device, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
