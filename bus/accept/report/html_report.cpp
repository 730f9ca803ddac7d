#include "accept/report/html_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "conform/report/html_report.hpp"
#include "diagnostics/place.hpp"
#include "text/counted.hpp"

namespace edsc::accept {
namespace {

using View = nlohmann::ordered_json;

/// Null for an empty text: the template omits the section.
View shown(const std::string& text) { return text.empty() ? View(nullptr) : View(text); }

View number_view(const std::optional<std::uint32_t>& number) {
  return number ? fmt::format("{:04X} {:04X}h", *number >> 16, *number & 0xFFFF) : std::string{"not known"};
}

View identity_view(const Acceptance& acceptance) {
  View rows = View::array();
  for (const IdentityRow& row : acceptance.identity()) {
    const bool compared = row.in_eds && row.in_device, is_declared = !row.deviation.empty();
    rows.push_back({{"number", row.number->name},
                    {"in_eds", number_view(row.in_eds)},
                    {"in_device", number_view(row.in_device)},
                    {"identity_class", is_declared   ? "deviates"
                                       : row.differs ? "failed"
                                       : compared    ? "passed"
                                                     : "other"},
                    {"identity_result", is_declared   ? "differs; declared: " + row.deviation
                                        : row.differs ? "differs"
                                        : compared    ? "same"
                                                      : "not compared"}});
  }
  return rows;
}

View findings_view(const Diagnostics& diagnostics) {
  View rows = View::array();
  for (const Diagnostic& finding : diagnostics.all()) {
    const Place place = place_of(finding.position);
    rows.push_back({{"severity", to_string(finding.severity)},
                    {"line", place.line == 0 ? std::string{} : fmt::format("{}", place.line)},
                    {"finding", finding.message},
                    {"finding_rule", finding.rule.text()}});
  }
  return rows;
}

std::string findings_sentence(const Diagnostics& diagnostics) {
  return fmt::format("{}, {}, {}", counted(diagnostics.errors(), "error"), counted(diagnostics.warnings(), "warning"),
                     counted(diagnostics.notes(), "note"));
}

View difference_view(const Difference& difference, const Acceptance& acceptance) {
  View corrections = View::array();
  for (const Correction& correction : difference.corrections) corrections.push_back(correction_text(correction));
  return {{"entry", entry_label(difference.index, difference.sub_index)},
          {"entry_name", difference.name},
          {"kind", row_of(difference.kind).text},
          {"mark", fmt::format("{}{}", row_of(difference.mark).text, difference.is_declared() ? ", declared" : "")},
          {"mark_class", difference.is_declared() ? "deviates" : row_of(difference.mark).name},
          {"in_eds", difference.in_eds},
          {"in_device", difference.in_device},
          {"reason", difference.reason},
          {"declared", shown(difference.deviation)},
          {"corrections", std::move(corrections)},
          {"frames", conform::frames_view(difference.frames, acceptance.run.node, acceptance.sheet)}};
}

/// Whether the entry is in a difference that is not declared. A missing object is one difference, with its first entry.
bool has_undeclared(const ComparedEntry& entry, const Comparison& comparison) {
  bool any = false;
  for (const Difference& difference : comparison.differences) {
    const bool of_object = difference.kind == Kind::object_missing;
    if (difference.index != entry.index || (!of_object && difference.sub_index != entry.sub_index)) continue;
    if (!difference.is_declared()) return true;
    any = true;
  }
  return !any;
}

std::string_view class_of(const ComparedEntry& entry, const Comparison& comparison) {
  if (differs(entry)) return has_undeclared(entry, comparison) ? "failed" : "deviates";
  if (entry.value == Aspect::may_differ) return "deviates";
  return entry.exists == Aspect::same ? "passed" : "other";
}

View entry_view(const ComparedEntry& entry, const Comparison& comparison) {
  return {{"entry", entry_label(entry.index, entry.sub_index)},
          {"entry_name", entry.name},
          {"type", entry.type},
          {"access", entry.access},
          {"default_value", entry.default_value},
          {"device_value", entry.device_value},
          {"entry_class", class_of(entry, comparison)},
          {"entry_result", result_text(entry)}};
}

}  // namespace

std::string html_report(const Acceptance& acceptance) {
  const Comparison& comparison = acceptance.comparison;
  const std::vector<std::string> objections = acceptance.objections();
  View differences = View::array();
  for (const Difference& difference : comparison.differences) {
    differences.push_back(difference_view(difference, acceptance));
  }
  View entries = View::array();
  for (const ComparedEntry& entry : comparison.entries) entries.push_back(entry_view(entry, comparison));
  View view = conform::run_view(acceptance.run, acceptance.sheet);
  view.update({{"accepted_class", objections.empty() ? "passed" : "failed"},
               {"accepted", headline(acceptance)},
               {"has_objections", !objections.empty()},
               {"objections", objections},
               {"check_sentence", findings_sentence(acceptance.findings)},
               {"has_findings", !acceptance.findings.all().empty()},
               {"findings", findings_view(acceptance.findings)},
               {"numbers", identity_view(acceptance)},
               {"differences_sentence", differences_sentence(comparison)},
               {"dictionary_differences", std::move(differences)},
               {"has_unstable", !comparison.unstable.empty()},
               {"unstable", comparison.unstable},
               {"entries_sentence", entries_sentence(comparison)},
               {"entries", std::move(entries)}});
  return render_html(with_parts("accept.html"), view);
}

}  // namespace edsc::accept
