/// The order of sections: CiA 306-1, clause 4.3.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// The place of a section in the canonical order. A list is followed by its objects; the objects in no list follow all
/// lists.
struct SectionPlace {
  std::uint32_t section = 0;  ///< place in the table, or of the list of an object, or of the first section of a module
  bool after_list = false;
  std::uint16_t number = 0;  ///< of a tool or module
  std::uint32_t section_of_module = 0;
  std::uint64_t object = 0;  ///< index, kind and sub-index

  friend auto operator<=>(const SectionPlace&, const SectionPlace&) = default;
};

/// `list` is that of the object of an object section.
[[nodiscard]] SectionPlace place_of_section(const SectionName& name, std::optional<ObjectListKind> list);

/// Of duplicate sections, the first remains, with the comments of both.
void drop_second_sections(Document& document);

/// The order of `section_rows`: each object list is followed by its objects, ascending; the sections of a module are
/// together. Unknown sections follow in their order.
void order_sections(Document& document, const DataSheet& sheet);

/// The list of an object: the list to which it belongs; for a data type, the list that contains it. Nothing if there is
/// none.
[[nodiscard]] std::optional<ObjectListKind> list_for(std::uint16_t index, const DataSheet& sheet);

}  // namespace edsc
