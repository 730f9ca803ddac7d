/// Findings as SARIF 2.1.0 for code review and CI systems.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// One run over any number of files. File names may contain bytes that are not UTF-8: dump the document with
/// nlohmann::json::error_handler_t::replace.
class SarifLog {
 public:
  /// `url_of` returns where a rule is documented, or nothing.
  SarifLog(std::string_view version, std::span<const Rule> rules, std::string (*url_of)(const Rule&));

  /// Adds findings in the order of report_order(). The source files need not outlive this call.
  void add(const Diagnostics& diagnostics);

  /// Adds a notification of the run, which is not a finding.
  void notify(const Position& position, const std::string& message);

  [[nodiscard]] nlohmann::ordered_json document() const;

 private:
  [[nodiscard]] nlohmann::ordered_json result_of(const Diagnostic& diagnostic) const;

  nlohmann::ordered_json driver_;
  std::map<RuleId, std::size_t> rule_index_;
  nlohmann::ordered_json results_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json notifications_ = nlohmann::ordered_json::array();
};

}  // namespace edsc
