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
  std::string_view misspelling;  ///< let through with a warning; may be empty
  WarningRule rule;              ///< for a count that is missing or differs
  bool numbers_count_up;         ///< from 1, without gaps; else they are sub-indices, and some may be left out
};

/// The entries in the order of the file, each number once. Checks the count against them.
[[nodiscard]] std::vector<NumberedField> read_numbered_section(const SourceFile& source, const IniSection& section,
                                                               const CountKey& count_key, Diagnostics& diagnostics);

}  // namespace edsc
