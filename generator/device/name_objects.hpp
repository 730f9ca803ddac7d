/// C++ names for all objects and entries.
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Sets identifiers: of objects, unique in the device; of entries, unique in the object.
void name_objects(Device& device, const Options& options);

}  // namespace edsc
