/// Device descriptions and configurations in XML: XDD and XDC of CiA 311, versions 1.0 and 1.1.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Tells XML from the INI form of CiA 306 by the first character that is no blank.
[[nodiscard]] bool is_xml(const SourceFile& source);

/// Sorts a profile into the data sheet that an EDS or DCF of the same device would give. What is not read is reported.
[[nodiscard]] DataSheet read_xdd(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace edsc
