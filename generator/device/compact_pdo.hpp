/// CompactPDO (CiA 306-1, 4.5): PDO parameters that the data sheet only counts.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Adds communication and mapping parameters until there are NrOfRXPDO and NrOfTXPDO PDOs: to PDOs that lack one of the
/// two, and new ones at the lowest free numbers. Bit n of CompactPDO says that communication parameters have sub-index
/// n + 1. The device's objects stay in order.
void add_compact_pdos(const DeviceInfo& info, Device& device, Diagnostics& diagnostics);

}  // namespace edsc
