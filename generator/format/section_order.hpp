/// The order of sections: CiA 306-1, clause 4.3.
#pragma once

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Of duplicate sections, the first remains, with the comments of both.
void drop_second_sections(Document& document);

/// The order of `section_rows`: each object list is followed by its objects, ascending; the sections of a module are
/// together. Unknown sections follow in their order.
void order_sections(Document& document, const DataSheet& sheet);

/// The list of an object: the list to which it belongs; for a data type, the list that contains it. Nothing if there is
/// none.
[[nodiscard]] std::optional<ObjectListKind> list_for(std::uint16_t index, const DataSheet& sheet);

}  // namespace edsc
