#include "accept/report/json_report.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "conform/report/json_report.hpp"
#include "conform/report/report_facts.hpp"
#include "device/device.hpp"
#include "diagnostics/print.hpp"
#include "text/printable.hpp"

namespace edsc::accept {
namespace {

using json = nlohmann::ordered_json;

/// Null for an empty text.
json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json number_or_null(const std::optional<std::uint32_t>& number) { return number ? json(*number) : json(nullptr); }

json correction_object(const Correction& correction) {
  return {{"section", correction.section},
          {"key", correction.key},
          {"old", correction.old_text ? json(*correction.old_text) : json(nullptr)},
          {"new", correction.new_text}};
}

json difference_object(const Difference& difference, const Acceptance& acceptance) {
  json corrections = json::array();
  for (const Correction& correction : difference.corrections) corrections.push_back(correction_object(correction));
  return {{"index", entry_label(difference.index, difference.sub_index)},
          {"name", text_or_null(difference.name)},
          {"kind", row_of(difference.kind).name},
          {"eds", difference.in_eds},
          {"device", difference.in_device},
          {"mark", row_of(difference.mark).name},
          {"evidence", difference.evidence},
          {"reason", difference.reason},
          {"corrections", std::move(corrections)},
          {"deviation", text_or_null(difference.deviation)},
          {"frames", conform::frame_objects(difference.frames, acceptance.run.node, acceptance.sheet)}};
}

json entry_object(const ComparedEntry& entry) {
  return {{"index", entry_label(entry.index, entry.sub_index)},
          {"in_eds", entry.in_eds},
          {"name", text_or_null(entry.name)},
          {"type", text_or_null(entry.type)},
          {"access", text_or_null(entry.access)},
          {"default_value", text_or_null(entry.default_value)},
          {"device_value", text_or_null(entry.device_value)},
          {"exists", row_of(entry.exists).name},
          {"length", row_of(entry.length).name},
          {"readable", row_of(entry.readable).name},
          {"value", row_of(entry.value).name},
          {"limits", row_of(entry.limits).name},
          {"remark", text_or_null(entry.remark)}};
}

json comparison_object(const Acceptance& acceptance) {
  const Comparison& comparison = acceptance.comparison;
  json counts = json::object();
  for (const MarkRow& row : marks) counts[std::string{row.name}] = comparison.count(row.mark);
  json differences = json::array();
  for (const Difference& difference : comparison.differences) {
    differences.push_back(difference_object(difference, acceptance));
  }
  json entries = json::array();
  for (const ComparedEntry& entry : comparison.entries) entries.push_back(entry_object(entry));
  return {{"interrupted", comparison.interrupted}, {"ended_early", text_or_null(comparison.lost)},
          {"unstable", comparison.unstable},       {"marks", std::move(counts)},
          {"differences", std::move(differences)}, {"entries", std::move(entries)}};
}

}  // namespace

std::string json_report(const Acceptance& acceptance) {
  const conform::RunReport& run = acceptance.run;
  const Diagnostics& findings = acceptance.findings;
  json identity = json::array();
  for (const IdentityRow& row : acceptance.identity()) {
    identity.push_back({{"number", row.number->key},
                        {"eds", number_or_null(row.in_eds)},
                        {"device", number_or_null(row.in_device)},
                        {"differs", row.differs},
                        {"deviation", text_or_null(row.deviation)}});
  }
  const std::vector<std::string> objections = acceptance.objections();
  const json report = {{"schema", 2},
                       {"edsc", run.version},
                       {"accepted", objections.empty()},
                       {"objections", objections},
                       {"title", text_or_null(run.title)},
                       {"operator", text_or_null(run.operator_name)},
                       {"place", text_or_null(run.place)},
                       {"started", text_or_null(run.started == 0 ? "" : conform::utc_text(run) + 'Z')},
                       {"bus", run.bus},
                       {"node_id", run.node},
                       {"eds", {{"file", run.sheet}, {"sha256", text_or_null(run.sheet_hash)}}},
                       {"options", conform::file_object(run.options_file)},
                       {"deviations", conform::file_object(run.deviations_file)},
                       {"check",
                        {{"errors", findings.errors()},
                         {"warnings", findings.warnings()},
                         {"notes", findings.notes()},
                         {"findings", json(print_json(findings)["diagnostics"])}}},
                       {"identity", std::move(identity)},
                       {"comparison", comparison_object(acceptance)},
                       {"conform", conform::run_object(run, acceptance.sheet)}};
  return json_text(report) + '\n';
}

}  // namespace edsc::accept
