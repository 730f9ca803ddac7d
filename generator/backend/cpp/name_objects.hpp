/// C++ names for a device, its objects and entries.
#pragma once

#include <string>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Sets the name of the device, its namespace: `name`, or the name of its file if that is empty. Sets identifiers: of
/// objects, unique in the device; of entries, unique in the object.
void name_objects(Device& device, const Options& options, const std::string& name);

}  // namespace edsc
