/// Area 1: the EDS itself (CiA 306-1).
#include <fmt/format.h>

#include <string>
#include <vector>

#include "conform/case.hpp"
#include "conform/dut/dut.hpp"
#include "conform/sheet_findings.hpp"

namespace edsc::conform {
namespace {

std::string list_of(const std::vector<std::string>& lines, std::size_t count) {
  std::string text = fmt::format("{}", fmt::join(lines, "; "));
  if (count > lines.size()) text += fmt::format("; and {} more", count - lines.size());
  return text;
}

/// Warnings do not fail the case: many of them are about style, and each names its rule.
void no_errors(Dut& dut) {
  const std::optional<SheetFindings>& findings = dut.findings();
  if (!findings) dut.inconclusive("the EDS was not checked; run `edsc check` on it");
  if (findings->warning_count != 0) {
    dut.warn(fmt::format("edsc check: {} {}: {}", findings->warning_count,
                         findings->warning_count == 1 ? "warning" : "warnings",
                         list_of(findings->warnings, findings->warning_count)));
  }
  dut.expect(findings->error_count == 0, "an EDS without errors", list_of(findings->errors, findings->error_count));
}

constexpr CaseRow sheet_rows[] = {
    {"1.0", "The EDS has no errors", "CiA 306-1, 4", Level::read, Permission::none, no_errors},
};

}  // namespace

std::span<const CaseRow> sheet_cases() { return sheet_rows; }

}  // namespace edsc::conform
