/// The default PDOs of a device, from the communication and mapping parameters 1400h..1BFFh (CiA 301, 7.5.2.35..38).
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Fills `device.pdos`. The objects of the device must not move afterwards, since PDOs point to them.
void resolve_pdos(Device& device, const Options& options);

}  // namespace edsc
