/// CompactPDO (CiA 306-1, 4.5): PDO parameters given only by their number.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Adds communication and mapping parameters up to NrOfRXPDO and NrOfTXPDO PDOs: first to PDOs without one of the two,
/// then at the lowest free numbers. Bit n of CompactPDO means that communication parameters have sub-index n + 1. The
/// objects of the device remain sorted.
void add_compact_pdos(const DeviceInfo& info, Device& device, Diagnostics& diagnostics);

}  // namespace edsc
