/// The findings of an audit as text, JSON and HTML.
#pragma once

#include <string>
#include <vector>

#include "audit/auditor.hpp"
#include "decode/log/print_message.hpp"

namespace edsc::audit {

struct Report {
  std::string log;
  Totals totals;
  Limits limits;
  const Decoder* decoder = nullptr;
  const NodeLabels* labels = nullptr;
  const Findings* findings = nullptr;
  const Incidents* incidents = nullptr;
  const CycleTimes* cycle_times = nullptr;
  const NetworkTimes* network_times = nullptr;  ///< null without a network file
  bool shows_cycles = false;                    ///< in text
  bool shows_times = false;                     ///< in text: those of the network
  bool shows_all = false;                       ///< in text and HTML: also the findings that follow from others

  /// Whether no finding is an error or a warning.
  [[nodiscard]] bool is_clean() const;
};

/// A line for each finding, as of a compiler, a summary, and the cycle times if wanted.
[[nodiscard]] std::string text_report(const Report& report, bool color);
/// By docs/schema/audit.schema.json.
[[nodiscard]] std::string json_report(const Report& report);
/// A page without links to other files.
[[nodiscard]] std::string html_report(const Report& report);

}  // namespace edsc::audit
