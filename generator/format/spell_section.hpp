/// One section in canonical spelling: its title, its keys and their order, numbers, counts.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Inline comments behind numbers become lines of their own, before the key. Of two keys of the same name the first
/// stays, and takes the comments of the second.
void spell_section(DocumentSection& section, const DataSheet& sheet, const Device& device);

}  // namespace edsc
