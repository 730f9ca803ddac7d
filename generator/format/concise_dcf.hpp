/// The concise DCF: what an NMT master downloads to configure a node, object 1F22h (CiA 302-3, 4.2).
#pragma once

#include <string>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The number of entries, then each with index, sub-index, length and data, low byte first; ascending. In it are the
/// writable entries whose ParameterValue differs from their default. `device` is that of `sheet`, with the node-ID. A
/// formula without node-ID, and a value that cannot be read, is reported; what the report is about is left out.
[[nodiscard]] std::string concise_dcf(const DataSheet& sheet, const Device& device, Diagnostics& diagnostics);

}  // namespace edsc
