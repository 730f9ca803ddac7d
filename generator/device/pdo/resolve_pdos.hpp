/// The default PDOs of a device (CiA 301, 7.5.2.35..38): compact form, mapping, validity.
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Adds communication and mapping parameters up to NrOfRXPDO and NrOfTXPDO PDOs: first to PDOs without one of the two,
/// then at the lowest free numbers. Bit n of CompactPDO means that communication parameters have sub-index n + 1. The
/// objects of the device remain sorted.
void add_compact_pdos(const DeviceInfo& info, Device& device, Diagnostics& diagnostics);

/// Fills `device.pdos`. The objects of the device must not move afterwards, since PDOs point to them.
void resolve_pdos(Device& device, const Options& options);

/// Marks PDOs with an invalid mapping as broken and reports why: as an error, but as a warning if the PDO is disabled
/// by default (bit 31 of its COB-ID). A BOOLEAN that is mapped as a byte is accepted with a warning.
void mark_broken_pdos(Device& device, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
