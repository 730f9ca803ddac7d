#include "diagnostics/sarif.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "diagnostics/place.hpp"
#include "diagnostics/report_order.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using json = nlohmann::ordered_json;

json location_of(const Position& position) {
  const Place place = place_of(position);
  return {{"physicalLocation",
           {{"artifactLocation", {{"uri", uri_of_path(place.file)}}},
            {"region",
             {{"startLine", place.line}, {"startColumn", place.column}, {"endColumn", place.column + place.length}}}}}};
}

json related_locations(const std::vector<Note>& notes) {
  json related = json::array();
  for (const Note& note : notes) {
    if (note.position.file == nullptr) continue;
    json location = location_of(note.position);
    location["message"] = {{"text", note.message}};
    related.push_back(std::move(location));
  }
  return related;
}

/// The finding from which a result follows.
void add_cause(const Diagnostic& cause, json& result) {
  json location = location_of(cause.position);
  location["message"] = {{"text", fmt::format("follows from {}: {}", cause.rule.text(), cause.message)}};
  result["relatedLocations"].push_back(std::move(location));
  result["properties"] = {{"followsFrom", cause.rule.text()}};
}

json suppression_of(const Allowance& allowance) {
  return {{"kind", allowance.in_source ? "inSource" : "external"},
          {"justification", allowance.reason},
          {"location", location_of(allowance.position)}};
}

}  // namespace

SarifLog::SarifLog(std::string_view version, std::span<const Rule> rules, std::string (*url_of)(const Rule&)) {
  json descriptors = json::array();
  for (const Rule& rule : rules) {
    rule_index_.emplace(RuleId{rule}, rule_index_.size());
    descriptors.push_back({{"id", rule.id},
                           {"shortDescription", {{"text", rule.title}}},
                           {"help", {{"text", rule.source}}},
                           {"defaultConfiguration", {{"level", to_string(rule.severity)}}}});
    if (const std::string url = url_of(rule); !url.empty()) descriptors.back()["helpUri"] = url;
  }
  driver_ = {{"name", "edsc"}, {"version", version}, {"rules", std::move(descriptors)}};
}

nlohmann::ordered_json SarifLog::result_of(const Diagnostic& diagnostic) const {
  json result = {{"ruleId", diagnostic.rule.text()}};
  if (const auto at = rule_index_.find(diagnostic.rule); at != rule_index_.end()) result["ruleIndex"] = at->second;
  result["level"] = to_string(diagnostic.severity);
  result["message"] = {{"text", diagnostic.message}};
  if (diagnostic.position.file != nullptr) result["locations"] = {location_of(diagnostic.position)};
  if (json related = related_locations(diagnostic.notes); !related.empty()) {
    result["relatedLocations"] = std::move(related);
  }
  if (diagnostic.places > 1) result["occurrenceCount"] = diagnostic.places;
  result["suppressions"] = json::array();
  return result;
}

void SarifLog::add(const Diagnostics& diagnostics) {
  for (const std::size_t at : report_order(diagnostics)) {
    const Diagnostic& one = diagnostics.all()[at];
    json result = result_of(one);
    if (one.follows_from) add_cause(diagnostics.all()[*one.follows_from], result);
    results_.push_back(std::move(result));
  }
  for (const Diagnostics::Suppressed& suppressed : diagnostics.suppressed()) {
    json result = result_of(suppressed.diagnostic);
    result["suppressions"].push_back(suppression_of(diagnostics.allowances()[suppressed.allowance]));
    results_.push_back(std::move(result));
  }
  for (const Diagnostics::Omitted& omitted : diagnostics.omitted()) {
    json notification = {
        {"level", "note"},
        {"message", {{"text", fmt::format("{} of {}", counted(omitted.count, "more finding"), omitted.rule.text())}}},
        {"associatedRule", {{"id", omitted.rule.text()}}}};
    if (omitted.file != nullptr) notification["locations"] = {location_of(Position{omitted.file})};
    notifications_.push_back(std::move(notification));
  }
}

void SarifLog::notify(const Position& position, const std::string& message) {
  json notification = {{"level", "note"}, {"message", {{"text", message}}}};
  if (position.file != nullptr) notification["locations"] = {location_of(position)};
  notifications_.push_back(std::move(notification));
}

nlohmann::ordered_json SarifLog::document() const {
  json run = {{"tool", {{"driver", driver_}}}, {"columnKind", "unicodeCodePoints"}};
  if (!notifications_.empty()) {
    run["invocations"] = {{{"executionSuccessful", true}, {"toolExecutionNotifications", notifications_}}};
  }
  run["results"] = results_;
  return {{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"}, {"version", "2.1.0"}, {"runs", {run}}};
}

}  // namespace edsc
