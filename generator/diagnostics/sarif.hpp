/// Findings as SARIF 2.1.0, which code review and CI systems read.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// A row of the rule table, as far as SARIF is concerned.
struct SarifRule {
  std::string_view id;
  Severity level;
  std::string_view description;
  std::string_view source;  ///< the clause
  std::string url;          ///< of its documentation
};

/// One run over any number of files. A file name may hold what is not UTF-8: dump the document with
/// nlohmann::json::error_handler_t::replace.
class SarifLog {
 public:
  SarifLog(std::string_view version, const std::vector<SarifRule>& rules);

  /// The source files need not live any longer than this call.
  void add(const Diagnostics& diagnostics);

  [[nodiscard]] nlohmann::ordered_json document() const;

 private:
  [[nodiscard]] nlohmann::ordered_json result_of(const Diagnostic& diagnostic) const;

  nlohmann::ordered_json driver_;
  std::unordered_map<std::string_view, std::size_t> rule_index_;
  nlohmann::ordered_json results_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json notifications_ = nlohmann::ordered_json::array();
};

}  // namespace edsc
