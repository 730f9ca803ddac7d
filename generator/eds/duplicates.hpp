/// Sections and keys that stand twice: the first one counts.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// `first` is the section that counts. Says whether the two differ.
void report_duplicate_section(const SourceFile& source, const IniSection& section, const IniSection& first,
                              Diagnostics& diagnostics);

/// `first` is the place of the value that counts.
void report_duplicate_key(const SourceFile& source, const IniEntry& entry, const Position& first,
                          Diagnostics& diagnostics);

}  // namespace edsc
