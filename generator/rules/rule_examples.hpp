/// Wrong and right examples of the rules of `edsc check`, from check_examples.txt.
#pragma once

#include <string>
#include <vector>

#include "rules/rule.hpp"

namespace edsc {

/// Each side has the changes of an EDS, or a whole file, and then those of its options file, if any. A line with only
/// `^` marks the position of the finding in the line above. A side is empty for a file that is missing or has no
/// changes.
struct RuleExample {
  std::vector<std::string> wrong;
  std::vector<std::string> right;
};

/// The rules of `edsc audit` and `edsc diff` do not have examples.
[[nodiscard]] const std::vector<RuleExample>& examples_of(RuleId rule);

}  // namespace edsc
