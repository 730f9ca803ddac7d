/// What cases provoke on purpose, in the terms of `edsc audit`: a log of the test has these findings even if the device
/// conforms. The JSON report names them, so that `edsc audit --conform` can tell them from others.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "audit/audit_rules.hpp"

namespace edsc::conform {

struct Provocation {
  audit::AuditRule rule;
  std::string_view cases;  ///< ids, separated by blanks; `start`: before the first case
  std::string_view by;     ///< what these cases do
};

[[nodiscard]] std::span<const Provocation> provocations();

/// The ids of the rules that a case provokes, or the start of a run.
[[nodiscard]] std::vector<std::string_view> provoked_by(std::string_view case_id);

}  // namespace edsc::conform
