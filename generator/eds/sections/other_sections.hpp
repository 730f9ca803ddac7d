/// Sections other than those of objects: comments, tools, dynamic channels, modules.
#pragma once

#include <span>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

/// [Comments] and [MxComments] (CiA 306-1, clause 4.7): `Lines=2`, `Line1=...`, `Line2=...`. Checks the count.
[[nodiscard]] Comments read_comments(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics);

/// [Tools] and [ToolX]: programs of the vendor for the device. `list` is null if [Tools] is missing. Checks the count
/// of sections.
[[nodiscard]] std::vector<Tool> read_tools(const SourceFile& source, const IniSection* list,
                                           std::span<const NamedSection> sections, Diagnostics& diagnostics);

/// [DynamicChannels]: the network variables of a programmable device (CiA 306-1, clause 4.8; CiA 302-4): `NrOfSeg=1`,
/// `Type1=0x0007`, `Dir1=ro`, `Range1=0xA080-0xA0BF`, `PPOffset1=0`. Checks the count.
[[nodiscard]] DynamicChannels read_dynamic_channels(const SourceFile& source, const IniSection& section,
                                                    Diagnostics& diagnostics);

/// [SupportedModules], [ConnectedModules] and the sections of each module (CiA 306-1, clause 6); null if missing.
struct ModuleSections {
  const IniSection* supported = nullptr;
  const IniSection* connected = nullptr;
  std::span<const NamedSection> modules;  ///< all sections that begin with MX
};

[[nodiscard]] Modules read_modules(const SourceFile& source, const ModuleSections& sections, Diagnostics& diagnostics);

}  // namespace edsc
