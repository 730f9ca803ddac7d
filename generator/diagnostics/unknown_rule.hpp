/// The message for an id that is not a row of a rule table.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "rules/rule.hpp"

namespace edsc {

/// `unknown rule "pdo-sise"; did you mean "pdo-size"?`
[[nodiscard]] std::string unknown_rule(std::string_view id, std::span<const Rule> table);

}  // namespace edsc
