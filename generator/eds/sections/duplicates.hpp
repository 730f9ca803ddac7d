/// Duplicate sections and keys; the first is used.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// `first` is the section that is used. The message states whether the contents differ.
void report_duplicate_section(const SourceFile& source, const IniSection& section, const IniSection& first,
                              Diagnostics& diagnostics);

/// `first` is the position of the value that is used.
void report_duplicate_key(const SourceFile& source, const IniEntry& entry, const Position& first,
                          Diagnostics& diagnostics);

}  // namespace edsc
