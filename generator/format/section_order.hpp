/// Which sections there are, and in which order: CiA 306-1, clause 4.3.
#pragma once

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// The first of two sections of the same name stays, and takes the comments of the second.
void drop_second_sections(Document& document);

/// FileInfo, DeviceInfo, DummyUsage, Comments, DeviceComissioning; then each object list and its objects, ascending;
/// then the rest in its order.
void order_sections(Document& document, const DataSheet& sheet);

/// The list where an object stands: the one where it belongs, of a data type the one that names it. Nothing when there
/// is none.
[[nodiscard]] std::optional<ObjectListKind> list_for(std::uint16_t index, const DataSheet& sheet);

/// The description of an object; null when the data sheet has none.
[[nodiscard]] const ObjectDescription* find_object(const DataSheet& sheet, std::uint16_t index);

}  // namespace edsc
