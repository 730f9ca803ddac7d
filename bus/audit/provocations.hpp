/// What the cases of `edsc conform` provoke, by its report as JSON. An audit of the log of a run lists such findings
/// by case, apart from the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rules/rule.hpp"

namespace edsc::audit {

/// A case that ran, and the frames of its time.
struct ProvokingCase {
  std::string id, title;      ///< empty: before the first case
  std::int64_t began_us = 0;  ///< as in the log
  std::int64_t ended_us = 0;  ///< when the next case began, so that restored values belong to it
  std::vector<RuleId> rules;  ///< that it provokes
};

/// The provoked occurrences of a rule.
struct Provoked {
  const ProvokingCase* by = nullptr;
  RuleId rule;
  std::size_t count = 0;
};

class Provocations {
 public:
  /// Reads the report. Returns nothing, with the problem, if it is not one.
  [[nodiscard]] static std::optional<Provocations> read(std::string_view json, std::string& problem);

  /// Counts an occurrence at this time of the log. Returns whether a case provokes it.
  bool count(RuleId rule, std::int64_t log_us);

  /// In the order of the cases, then of the rules.
  [[nodiscard]] std::vector<Provoked> counted() const;

 private:
  std::vector<ProvokingCase> cases_;                              ///< in the order in which they ran
  std::map<std::pair<std::size_t, RuleId>, std::size_t> counts_;  ///< by place of the case and rule
};

}  // namespace edsc::audit
