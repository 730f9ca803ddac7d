/// Device descriptions and configurations in XML: XDD and XDC of CiA 311, versions 1.0 and 1.1.
#pragma once

#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "xdd/not_in_eds.hpp"

namespace edsc {

/// Distinguishes XML from the INI format of CiA 306 by the first non-blank character.
[[nodiscard]] bool is_xml(const SourceFile& source);

/// Reads a profile into the data sheet that an EDS or DCF of the same device would give. Ignored parts are reported;
/// parts that an EDS cannot express are added to `not_in_eds`, if given.
[[nodiscard]] DataSheet read_xdd(const SourceFile& source, Diagnostics& diagnostics,
                                 std::vector<NotInEds>* not_in_eds = nullptr);

/// Why no EDS or DCF is written to a file of this name: it names an XDD or XDC, which edsc only reads. Empty otherwise.
[[nodiscard]] std::string xdd_name_problem(const std::string& path);

}  // namespace edsc
