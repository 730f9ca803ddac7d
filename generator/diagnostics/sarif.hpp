/// Findings as SARIF 2.1.0 for code review and CI systems.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// The part of a row of the rule table that SARIF needs.
struct SarifRule {
  std::string_view id;
  Severity level;
  std::string_view description;
  std::string_view source;  ///< the clause
  std::string url;          ///< of its documentation
};

/// One run over any number of files. File names may contain bytes that are not UTF-8: dump the document with
/// nlohmann::json::error_handler_t::replace.
class SarifLog {
 public:
  SarifLog(std::string_view version, const std::vector<SarifRule>& rules);

  /// The source files need not outlive this call.
  void add(const Diagnostics& diagnostics);

  /// Adds a notification of the run, which is not a finding.
  void notify(const Position& position, const std::string& message);

  [[nodiscard]] nlohmann::ordered_json document() const;

 private:
  [[nodiscard]] nlohmann::ordered_json result_of(const Diagnostic& diagnostic) const;

  nlohmann::ordered_json driver_;
  std::unordered_map<std::string_view, std::size_t> rule_index_;
  nlohmann::ordered_json results_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json notifications_ = nlohmann::ordered_json::array();
};

}  // namespace edsc
