/// Rules over objects and entries.
#pragma once

#include "device/device.hpp"

namespace edsc {

void check_objects(Device& device, Diagnostics& diagnostics);

}  // namespace edsc
