#include <algorithm>
#include <utility>

#include "diagnostics/place.hpp"
#include "lsp/features.hpp"
#include "rules/check_rules.hpp"

namespace edsc::lsp {
namespace {

constexpr std::size_t max_related = 20;

enum Severities { error_severity = 1, warning_severity = 2, information_severity = 3 };

int severity_number(Severity severity) {
  if (severity == Severity::note) return information_severity;
  return severity == Severity::error ? error_severity : warning_severity;
}

/// The tags of the protocol: 1 unnecessary, 2 deprecated.
Json tags_of(RuleId rule) {
  static const AnyRule unnecessary[] = {"unknown-key",      "unknown-section", "duplicate-key", "duplicate-section",
                                        "overlay-obsolete", "allow-unused",    "stray-line"};
  static const AnyRule deprecated[] = {"deprecated-option", "obsolete-object", "pdo-compatibility-entry"};
  if (std::ranges::find(unnecessary, rule) != std::end(unnecessary)) return Json::array({1});
  if (std::ranges::find(deprecated, rule) != std::end(deprecated)) return Json::array({2});
  return nullptr;
}

Json related_to(const Diagnostic& one, const Diagnostics& all, PositionEncoding encoding) {
  Json related = Json::array();
  const auto add = [&](const Position& position, const std::string& message) {
    Json location = location_of(position, encoding);
    if (!location.is_null()) related.push_back({{"location", std::move(location)}, {"message", message}});
  };
  for (const Note& note : one.notes) {
    if (related.size() == max_related) break;
    add(note.position, note.message);
  }
  if (one.follows_from) {
    const Diagnostic& cause = all.all()[*one.follows_from];
    add(cause.position, "follows from: " + cause.message);
  }
  return related;
}

}  // namespace

Published diagnostics_of(const Analysis& analysis, const std::function<std::string(const Rule&)>& url_of,
                         PositionEncoding encoding) {
  Published published;
  for (const Diagnostic& one : analysis.diagnostics.all()) {
    const Position origin = origin_of(one.position);
    if (origin.file == nullptr) continue;
    Json row{{"range", to_json(range_of(origin, encoding))},
             {"severity", severity_number(one.severity)},
             {"code", one.rule.text()},
             {"source", "edsc"},
             {"message", one.message}};
    if (const std::string url = url_of ? url_of(one.rule.row()) : std::string{}; !url.empty()) {
      row["codeDescription"] = {{"href", url}};
    }
    if (Json tags = tags_of(one.rule); !tags.is_null()) row["tags"] = std::move(tags);
    if (Json related = related_to(one, analysis.diagnostics, encoding); !related.empty()) {
      row["relatedInformation"] = std::move(related);
    }
    Json& rows = published[uri_of_file(origin.file->name())];
    if (rows.is_null()) rows = Json::array();
    rows.push_back(std::move(row));
  }
  return published;
}

}  // namespace edsc::lsp
