/// [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]: CiA 306-1, clause 4.6.1.
#pragma once

#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "text/ini.hpp"

namespace edsc {

/// The three sections; null where one is missing.
struct ObjectListSections {
  const IniSection* mandatory = nullptr;
  const IniSection* optional = nullptr;
  const IniSection* manufacturer = nullptr;
};

/// The objects of all lists, mandatory ones first, each index once.
[[nodiscard]] std::vector<ListedObject> read_object_lists(const SourceFile& source, const ObjectListSections& sections,
                                                          Diagnostics& diagnostics);

/// Warns of listed objects without section, and of sections in no list.
void compare_lists_with_objects(const DataSheet& sheet, Diagnostics& diagnostics);

}  // namespace edsc
