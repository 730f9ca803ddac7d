/// The findings of `edsc check` about the EDS of the device under test.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc::conform {

struct SheetFindings {
  std::vector<std::string> errors;    ///< `drive.eds:12:3: missing DataType [data-type]`, the first `max_named`
  std::vector<std::string> warnings;  ///< the same
  std::size_t error_count = 0;
  std::size_t warning_count = 0;

  static constexpr std::size_t max_named = 5;
};

/// The caller that loads the EDS stores the result in `DutSettings::findings`.
[[nodiscard]] SheetFindings sheet_findings(const Diagnostics& diagnostics);

}  // namespace edsc::conform
