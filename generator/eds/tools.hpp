/// [Tools] and [ToolX]: programs of the vendor for the device.
#pragma once

#include <span>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/section_name.hpp"

namespace edsc {

/// `list` is null if [Tools] is missing. Checks the count of sections.
[[nodiscard]] std::vector<Tool> read_tools(const SourceFile& source, const IniSection* list,
                                           std::span<const NamedSection> sections, Diagnostics& diagnostics);

}  // namespace edsc
