/// The JSON view of a device for the C++ templates.
#pragma once

#include <nlohmann/json.hpp>

#include "backend/cpp/cpp_names.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Declarations and tables as lines of C++. Reports objects that do not fit into the memory of the dictionary.
[[nodiscard]] nlohmann::ordered_json cpp_view(const NamedDevice& named, const Options& options,
                                              Diagnostics& diagnostics);

}  // namespace edsc
