/// The rule table: what may be wrong with a data sheet, how bad it is, and which clause says so.
#pragma once

#include <span>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

struct Rule {
  std::string_view id;
  Severity severity;  ///< what it usually is; a few rules warn where the value can still be read
  std::string_view meaning;
  std::string_view source;  ///< clause of a CiA document, or "edsc" where it is a rule of this compiler
};

[[nodiscard]] std::span<const Rule> all_rules();

/// Null when there is no such rule.
[[nodiscard]] const Rule* find_rule(std::string_view id);

}  // namespace edsc
