/// [Tools] and [ToolX]: programs of the vendor that go with the device.
#pragma once

#include <span>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/section_name.hpp"

namespace edsc {

/// `list` is null when there is no [Tools]. Checks its count against the sections.
[[nodiscard]] std::vector<Tool> read_tools(const SourceFile& source, const IniSection* list,
                                           std::span<const NamedSection> sections, Diagnostics& diagnostics);

}  // namespace edsc
