/// Units that other objects of a device state, where a command only listens.
#pragma once

#include <cstdint>

#include "device/device.hpp"

namespace edsc {

/// Reports that units and scales are those of the default values of the EDS, if the node can have others.
void report_default_scales(std::uint8_t node, const Device& device);

}  // namespace edsc
