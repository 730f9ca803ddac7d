/// The generated headers of a device.
#pragma once

#include <string>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "device/options/options.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// The headers of a device by the built-in templates, in the folder of its namespace. Reports a device that does not
/// fit into the memory of a dictionary.
[[nodiscard]] std::vector<OutputFile> headers_of(const Device& device, const Options& options, const std::string& space,
                                                 Diagnostics& diagnostics);

}  // namespace edsc
