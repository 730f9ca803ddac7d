/// [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]: CiA 306-1, clause 4.6.1.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// `MandatoryObjects` and its like.
[[nodiscard]] std::string_view section_name(ObjectListKind kind);

/// The list to which an object belongs. Nothing for the data types below 1000h, for which CiA 306 does not define a
/// list.
[[nodiscard]] std::optional<ObjectListKind> list_of(std::uint16_t index);

/// The three sections; null if missing.
struct ObjectListSections {
  const IniSection* mandatory = nullptr;
  const IniSection* optional = nullptr;
  const IniSection* manufacturer = nullptr;
};

/// The objects of all lists, mandatory ones first, each index once.
[[nodiscard]] std::vector<ListedObject> read_object_lists(const SourceFile& source, const ObjectListSections& sections,
                                                          Diagnostics& diagnostics);

/// Reports listed objects without section, and sections that are not listed.
void compare_lists_with_objects(const DataSheet& sheet, Diagnostics& diagnostics);

}  // namespace edsc
