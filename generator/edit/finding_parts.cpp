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

Json to_json(const Fix& fix) {
  Json changes = Json::array();
  for (const SheetChange& change : fix.changes) changes.push_back(change_as_json(change));
  return {{"title", fix.title}, {"changes", std::move(changes)}, {"needs_reason", fix.needs_reason}};
}

Json fixes_json(const Fixes& fixes, const Diagnostic& one) {
  Json list = Json::array();
  for (const Fix& fix : fixes.at(one.rule, one.position.line)) list.push_back(to_json(fix));
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

void add_findings(const OpenSheet& sheet, bool can_allow, EditParts& parts) {
  const SheetText text{*sheet.source};
  const Fixes fixes{text, sheet.diagnostics, sheet.device ? &*sheet.device : nullptr};
  const std::vector<Diagnostic>& all = sheet.diagnostics.all();
  Json list = Json::array();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note}) {
    for (const Diagnostic& one : all) {
      if (one.severity != severity || list.size() == max_findings) continue;
      Json finding = finding_json(sheet, one, &fixes);
      finding["id"] = list.size();
      if (can_allow && !finding["section"].get_ref<const std::string&>().empty()) {
        if (const auto allowance = fixes.allowance(one.rule, one.position.line)) {
          finding["fixes"].push_back(to_json(*allowance));
        }
      }
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
