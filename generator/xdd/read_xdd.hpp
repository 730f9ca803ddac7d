/// Device descriptions and configurations in XML: XDD and XDC of CiA 311, versions 1.0 and 1.1.
#pragma once

#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "xdd/not_in_eds.hpp"

namespace edsc {

/// Tells XML from the INI form of CiA 306 by the first character that is no blank.
[[nodiscard]] bool is_xml(const SourceFile& source);

/// Sorts a profile into the data sheet that an EDS or DCF of the same device would give. What is not read is reported;
/// what an EDS cannot express is added to `not_in_eds`, if given.
[[nodiscard]] DataSheet read_xdd(const SourceFile& source, Diagnostics& diagnostics,
                                 std::vector<NotInEds>* not_in_eds = nullptr);

}  // namespace edsc
