/// The object lists, written anew from the objects that are there: CiA 306-1, clause 4.6.1.
#pragma once

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Each list gets the objects that belong in it, ascending, and their number. A list that the file lacks is added when
/// there are objects for it. Comments go with the object that they stand before.
void renew_object_lists(Document& document, const DataSheet& sheet);

}  // namespace edsc
