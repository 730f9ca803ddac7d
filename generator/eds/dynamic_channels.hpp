/// [DynamicChannels]: the network variables of a programmable device (CiA 306-1, clause 4.8; CiA 302-4).
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// `NrOfSeg=1`, `Type1=0x0007`, `Dir1=ro`, `Range1=0xA080-0xA0BF`, `PPOffset1=0`. Checks the count.
[[nodiscard]] DynamicChannels read_dynamic_channels(const SourceFile& source, const IniSection& section,
                                                    Diagnostics& diagnostics);

}  // namespace edsc
