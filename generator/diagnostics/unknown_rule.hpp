/// The message for an id that is not a row of the rule table.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// `unknown rule "pdo-sise"; did you mean "pdo-size"?`
[[nodiscard]] std::string unknown_rule(std::string_view id);

}  // namespace edsc
