/// Modular devices: [SupportedModules], [ConnectedModules] and the sections of each module (CiA 306-1, clause 6).
#pragma once

#include <span>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/section_name.hpp"

namespace edsc {

/// Null if a section is missing.
struct ModuleSections {
  const IniSection* supported = nullptr;
  const IniSection* connected = nullptr;
  std::span<const NamedSection> modules;  ///< all sections that begin with MX
};

[[nodiscard]] Modules read_modules(const SourceFile& source, const ModuleSections& sections, Diagnostics& diagnostics);

}  // namespace edsc
