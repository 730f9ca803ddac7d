/// Converts a data sheet of any format to the sections of an EDS or DCF, for XDD and XDC.
#pragma once

#include <string>

#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// The sections of CiA 306-1 for a data sheet: [FileInfo], [DeviceInfo], [DummyUsage], [DeviceComissioning], the object
/// lists and the objects. `file_name` becomes FileName. ParameterValues without a DCF have no meaning and are ignored.
/// A text of several lines becomes one line.
[[nodiscard]] Document document_of(const DataSheet& sheet, const std::string& file_name);

}  // namespace edsc
