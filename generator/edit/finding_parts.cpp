#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/fixes.hpp"
#include "edit/sheet_parts.hpp"

namespace edsc::edit {
namespace {

constexpr std::size_t max_findings = 500;

Json fixes_json(const Fixes& fixes, const Diagnostic& one) {
  std::vector<Fix> all = fixes.at(one.rule, one.position.line);
  if (auto allowance = fixes.allowance(one.rule, one.position.line)) all.push_back(*std::move(allowance));
  Json list = Json::array();
  for (const Fix& fix : all) {
    Json changes = Json::array();
    for (const SheetChange& change : fix.changes) changes.push_back(change_as_json(change));
    list.push_back({{"title", fix.title}, {"changes", std::move(changes)}, {"needs_reason", fix.needs_reason}});
  }
  return list;
}

}  // namespace

Json finding_json(const OpenSheet& sheet, const Diagnostic& one, const Fixes* fixes) {
  const bool is_here = one.position.file == sheet.source.get() && one.position.line > 0;
  const TextSection* const section = is_here && fixes != nullptr ? fixes->section_at(one.position.line) : nullptr;
  const bool is_object = section != nullptr && is_object_section(section->name.kind);
  std::string message = one.message;
  if (one.places > 1) message += fmt::format(" (at {} places)", one.places);
  return {{"severity", to_string(one.severity)},
          {"rule", one.rule.text()},
          {"message", std::move(message)},
          {"line", is_here ? one.position.line : 0},
          {"section", section == nullptr ? std::string_view{} : section->title},
          {"object", is_object ? fmt::format("{:04X}", section->name.index) : ""},
          {"fixes", section == nullptr ? Json::array() : fixes_json(*fixes, one)}};
}

void add_findings(const OpenSheet& sheet, SheetParts& parts) {
  const SheetText text{*sheet.source};
  const Fixes fixes{text, sheet.diagnostics, sheet.device ? &*sheet.device : nullptr};
  const std::vector<Diagnostic>& all = sheet.diagnostics.all();
  Json list = Json::array();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    for (const Diagnostic& one : all) {
      if (one.severity != severity || list.size() == max_findings) continue;
      Json finding = finding_json(sheet, one, &fixes);
      finding["id"] = list.size();
      list.push_back(std::move(finding));
    }
  }
  const std::size_t total = sheet.diagnostics.errors() + sheet.diagnostics.warnings() + sheet.diagnostics.notes();
  const std::size_t more = total - std::min(total, list.size());
  parts.set("findings", {{"errors", sheet.diagnostics.errors()},
                         {"warnings", sheet.diagnostics.warnings()},
                         {"list", std::move(list)},
                         {"more", more}});
}

}  // namespace edsc::edit
