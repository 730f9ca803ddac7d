/// Rules over default PDO mappings.
#pragma once

#include "device/device.hpp"

namespace edsc {

void check_pdos(Device& device, Diagnostics& diagnostics);

}  // namespace edsc
