/// The sections of the objects: [HHHH], [HHHHsubHH], [HHHHName], [HHHHValue], [HHHHDenotation], [HHHHObjectLinks].
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

struct ObjectSection {
  SectionName name;
  const IniSection* section = nullptr;

  /// Sort key: groups the sections of one index, the object before its sub-objects before the lists of a compact form.
  [[nodiscard]] std::uint32_t order() const;
};

/// Reads objects from their sections, which may be in any order. Returns them ascending by index, each index once.
/// `prefix` precedes the index in the section names: empty, or `M1Fixed`.
[[nodiscard]] std::vector<ObjectDescription> read_objects(const SourceFile& source, std::vector<ObjectSection> sections,
                                                          std::string_view prefix, Diagnostics& diagnostics);

/// Sets the position of an entry and its fields to that of its section.
void place_entry(const Position& position, EntryDescription& entry);

}  // namespace edsc
