/// Findings that follow from others: a row is a rule, how far its findings reach, and the rules of which findings
/// follow from them. edsc reports the cause, and lists what follows from it on demand.
#pragma once

#include <span>
#include <vector>

#include "rules/check_rules.hpp"

namespace edsc {

enum class CauseReach : std::uint8_t {
  file,    ///< all findings of the file
  object,  ///< findings of the same object
};

struct CauseRow {
  AnyRule cause;
  CauseReach reach;
  std::vector<AnyRule> consequences;
  Severity min_severity = Severity::note;  ///< of the cause
};

/// The table, in the order in which causes are tried.
[[nodiscard]] std::span<const CauseRow> cause_rows();

}  // namespace edsc
