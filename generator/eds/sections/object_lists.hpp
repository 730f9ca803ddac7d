/// [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects]: CiA 306-1, clause 4.6.1.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

/// The section of a list.
[[nodiscard]] SectionKind section_of(ObjectListKind list);

/// The list to which an object belongs. Nothing for the data types below 1000h, for which CiA 306 does not define a
/// list.
[[nodiscard]] std::optional<ObjectListKind> list_of(std::uint16_t index);

/// The objects of all lists, mandatory ones first, each index once. The sections are in the order of ObjectListKind,
/// null if missing.
[[nodiscard]] std::vector<ListedObject> read_object_lists(const SourceFile& source,
                                                          const std::array<const IniSection*, 3>& sections,
                                                          Diagnostics& diagnostics);

/// Reports listed objects without section, and sections that are not listed.
void compare_lists_with_objects(const DataSheet& sheet, Diagnostics& diagnostics);

}  // namespace edsc
