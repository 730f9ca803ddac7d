/// The order of findings in a report.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// The indices of all findings in `all()`: by file, in the order in which the files were read, then the most severe
/// ones first, then by line. Findings that follow from another one come directly after it.
[[nodiscard]] std::vector<std::size_t> report_order(const Diagnostics& diagnostics);

/// The number of findings of a rule that follow from a finding.
struct Consequence {
  RuleId rule;
  std::size_t count = 0;
};

/// The findings that follow from the finding with an index, with those that are only counted.
[[nodiscard]] std::vector<Consequence> consequences_of(std::size_t cause, const Diagnostics& diagnostics);

/// The findings that do not follow from another one, of the severities warning and error, with those that are only
/// counted.
[[nodiscard]] std::size_t count_causes(const Diagnostics& diagnostics);

}  // namespace edsc
