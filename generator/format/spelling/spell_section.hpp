/// One section in canonical spelling: its title, its keys and their order, numbers, counts.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Inline comments after numbers become separate lines before the key. Of duplicate keys, the first remains, with the
/// comments of both.
void spell_section(DocumentSection& section, const DataSheet& sheet, const Device& device);

}  // namespace edsc
