/// C++ names for all objects and entries.
#pragma once

#include "device/device.hpp"
#include "device/options.hpp"

namespace edsc {

/// Gives each object an identifier that is unique in the device, each entry one that is unique in its object.
void name_objects(Device& device, const Options& options);

}  // namespace edsc
