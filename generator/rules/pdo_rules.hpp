/// Rules over default PDO mappings.
#pragma once

#include "device/device.hpp"
#include "device/options.hpp"

namespace edsc {

/// Marks those PDOs as broken of which no layout can be made.
void check_pdos(Device& device, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
