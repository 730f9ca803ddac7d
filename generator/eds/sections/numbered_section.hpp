/// Sections that are a counted list: `SupportedObjects=3`, `1=0x1000`, ...
#pragma once

#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"

namespace edsc {

struct CountKey {
  std::string_view name;         ///< as CiA 306 spells it
  std::string_view misspelling;  ///< accepted with a warning; may be empty
  WarningRule rule;              ///< for a missing or wrong count
  bool numbers_count_up;         ///< from 1, without gaps; otherwise sub-indices, possibly with gaps
};

/// Returns the entries in the order of the file, each number once. Checks the count.
[[nodiscard]] std::vector<NumberedField> read_numbered_section(const SourceFile& source, const IniSection& section,
                                                               const CountKey& count_key, Diagnostics& diagnostics);

}  // namespace edsc
