/// The object lists, rewritten from the existing objects: CiA 306-1, clause 4.6.1.
#pragma once

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Each list gets its objects, ascending, and their number. A missing list is added if there are objects for it.
/// Comments remain before their object.
void renew_object_lists(Document& document, const DataSheet& sheet);

}  // namespace edsc
