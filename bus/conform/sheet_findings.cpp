#include "conform/sheet_findings.hpp"

#include <fmt/format.h>

#include "diagnostics/place.hpp"

namespace edsc::conform {
namespace {

std::string line_of(const Diagnostic& finding) {
  const Place place = place_of(finding.position);
  return fmt::format("{}:{}:{}: {} [{}]", place.file, place.line, place.column, finding.message, finding.rule.text());
}

}  // namespace

SheetFindings sheet_findings(const Diagnostics& diagnostics) {
  SheetFindings findings;
  findings.error_count = diagnostics.errors();
  findings.warning_count = diagnostics.warnings();
  for (const Diagnostic& finding : diagnostics.all()) {
    if (finding.severity == Severity::note) continue;
    auto& lines = finding.severity == Severity::error ? findings.errors : findings.warnings;
    if (lines.size() < SheetFindings::max_named) lines.push_back(line_of(finding));
  }
  return findings;
}

}  // namespace edsc::conform
