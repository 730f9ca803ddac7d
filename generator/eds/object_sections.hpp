/// The sections of the objects: [HHHH], [HHHHsubHH], [HHHHName], [HHHHValue], [HHHHDenotation], [HHHHObjectLinks].
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/keys.hpp"
#include "eds/section_name.hpp"

namespace edsc {

struct ObjectSection {
  SectionName name;
  const IniSection* section = nullptr;

  /// Sorting by it brings those of one index together: the object's own before its sub-objects before the lists of a
  /// compact form.
  [[nodiscard]] std::uint32_t order() const {
    return (std::uint32_t{name.index} << 16U) | (static_cast<std::uint32_t>(name.kind) << 8U) | name.sub_index;
  }
};

/// Makes objects of their sections, which may come in any order. Ascending by index, each index once. `prefix` is what
/// stands before the index in the names of the sections: nothing, or `M1Fixed`.
[[nodiscard]] std::vector<ObjectDescription> read_objects(const SourceFile& source, std::vector<ObjectSection> sections,
                                                          std::string_view prefix, Diagnostics& diagnostics);

/// Gives an entry and its fields the place of its section.
void place_entry(const Position& position, EntryDescription& entry);

/// The keys that objects, sub-objects and the extensions of modules share.
[[nodiscard]] KeyMatch find_entry_key(std::string_view key, EntryDescription& entry);
[[nodiscard]] std::span<const KeyRow<EntryDescription>> entry_key_table();

}  // namespace edsc
