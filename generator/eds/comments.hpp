/// [Comments] and [MxComments]: CiA 306-1, clause 4.7.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// `Lines=2`, `Line1=...`, `Line2=...`. Checks the count.
[[nodiscard]] Comments read_comments(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics);

}  // namespace edsc
