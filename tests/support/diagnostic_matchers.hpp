/// Matchers for the diagnostics of the generator's front end.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// One finding, without its message.
struct Finding {
  Severity severity;
  std::string rule;
  std::uint32_t line;
  std::uint32_t column;

  bool operator==(const Finding&) const = default;
  friend std::ostream& operator<<(std::ostream& out, const Finding& finding) {
    return out << to_string(finding.severity) << " [" << finding.rule << "] at " << finding.line << ":"
               << finding.column;
  }
};

inline Finding error_at(std::uint32_t line, std::uint32_t column, std::string rule) {
  return {Severity::error, std::move(rule), line, column};
}

inline Finding warning_at(std::uint32_t line, std::uint32_t column, std::string rule) {
  return {Severity::warning, std::move(rule), line, column};
}

inline Finding note_at(std::uint32_t line, std::uint32_t column, std::string rule) {
  return {Severity::note, std::move(rule), line, column};
}

inline std::vector<Finding> findings(const Diagnostics& diagnostics) {
  std::vector<Finding> result;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    result.push_back({diagnostic.severity, std::string(diagnostic.rule.text()), diagnostic.position.line,
                      diagnostic.position.column});
  }
  return result;
}

inline std::vector<std::string> messages(const Diagnostics& diagnostics) {
  std::vector<std::string> result;
  for (const Diagnostic& diagnostic : diagnostics.all()) result.push_back(diagnostic.message);
  return result;
}

/// The findings of one rule.
inline std::vector<Finding> findings(const Diagnostics& diagnostics, std::string_view rule) {
  std::vector<Finding> result = findings(diagnostics);
  result.erase(std::remove_if(result.begin(), result.end(), [&](const Finding& f) { return f.rule != rule; }),
               result.end());
  return result;
}

}  // namespace edsc
