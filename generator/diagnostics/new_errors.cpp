#include "diagnostics/new_errors.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace edsc {

std::vector<Diagnostic> new_errors(const Diagnostics& after, const Diagnostics& before, bool is_renamed) {
  std::map<std::pair<RuleId, std::string>, std::size_t> old_errors;
  std::map<RuleId, std::int64_t> more;
  for (const Diagnostic& one : before.all()) {
    if (one.severity != Severity::error) continue;
    ++old_errors[{one.rule, one.message}];
    --more[one.rule];
  }
  std::vector<Diagnostic> errors;
  for (const Diagnostic& one : after.all()) {
    if (one.severity == Severity::error) ++more[one.rule];
  }
  for (const Diagnostic& one : after.all()) {
    if (one.severity != Severity::error || (is_renamed && more[one.rule] <= 0)) continue;
    std::size_t& same = old_errors[{one.rule, one.message}];
    if (same > 0) {
      --same;
    } else {
      errors.push_back(one);
    }
  }
  return errors;
}

}  // namespace edsc
