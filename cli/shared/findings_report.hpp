/// Prints the findings about files as text, JSON or SARIF.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device/left_out.hpp"
#include "diagnostics/diagnostics.hpp"
#include "diagnostics/sarif.hpp"
#include "shared/common_options.hpp"

namespace edsc {

/// Where a rule is documented.
[[nodiscard]] std::string url_of(const Rule& rule);

/// Text is printed at once, JSON and SARIF by finish().
class FindingsReport {
 public:
  /// `format` is `text`, `json` or `sarif`. `all`: the text has findings that follow from others, and all places.
  FindingsReport(std::string format, const ColorOption& color, bool all);

  void add(const Diagnostics& diagnostics);

  /// In SARIF they are notifications: they are consequences of the findings, and do not have a rule.
  void add_left_out(const std::vector<LeftOut>& left_out);

  /// The load and the response times of a network, for JSON.
  void add_network(nlohmann::json network);

  void finish() const;

 private:
  void add_json(const nlohmann::json& one);

  std::string format_;
  const ColorOption& color_;
  bool all_;
  std::optional<SarifLog> sarif_;  ///< only for SARIF: it lists all rules
  nlohmann::json json_;
};

}  // namespace edsc
