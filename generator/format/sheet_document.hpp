/// A device description of any format as the sections of an EDS or DCF: for XDD and XDC.
#pragma once

#include <string>

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// The sections of CiA 306-1 that say what the sheet says: [FileInfo], [DeviceInfo], [DummyUsage], [DeviceComissioning],
/// the object lists and the objects. `file_name` becomes FileName. The ParameterValues of a sheet that is not a DCF have
/// no meaning and are left out. A text of several lines becomes one line.
[[nodiscard]] Document document_of(const DataSheet& sheet, const std::string& file_name);

}  // namespace edsc
