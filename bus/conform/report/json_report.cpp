#include "conform/report/json_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "conform/provocations.hpp"
#include "conform/report/decoded_frames.hpp"
#include "conform/report/report_facts.hpp"
#include "text/printable.hpp"
#include "values/append.hpp"

namespace edsc::conform {
namespace {

using json = nlohmann::ordered_json;

/// Null for an empty text.
json text_or_null(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

json frame_object(const SeenFrame& seen, const Message& message) {
  std::string data;
  append_hex_bytes(data, data_of(seen.frame), "");
  return {{"at_us", seen.at},
          {"sent", seen.sent},
          {"can_id", seen.frame.id},
          {"extended", seen.frame.extended},
          {"remote", seen.frame.remote},
          {"size", seen.frame.size},
          {"data", std::move(data)},
          {"service", row_of(message.service).name},
          {"text", message.text},
          {"problem", message.problem}};
}

/// Null unless a repetition has another verdict.
json first_run_object(const CaseResult& result, const RunReport& run, const Device& sheet) {
  if (!result.first_run) return nullptr;
  const FirstRun& first = *result.first_run;
  return {{"expected", first.expected},
          {"got", first.got},
          {"failed_frames", first.failed_frames},
          {"frames", frame_objects(first.frames, run.node, sheet)}};
}

json ids(const std::vector<const CaseResult*>& cases) {
  json list = json::array();
  for (const CaseResult* result : cases) list.push_back(result->row->id);
  return list;
}

/// Null for no condition.
json condition_name(Condition condition) {
  if (condition == Condition::none) return nullptr;
  return std::ranges::find(conditions, condition, &ConditionRow::condition)->name;
}

json condition_names(Condition all) {
  json names = json::array();
  for (const ConditionRow& row : conditions) {
    if (includes(all, row.condition)) names.push_back(row.name);
  }
  return names;
}

json causes_array(const RunReport& run) {
  json causes = json::array();
  for (const Cause& cause : run.causes()) causes.push_back({{"text", cause.text}, {"cases", ids(cause.cases)}});
  return causes;
}

json missing_conditions_array(const RunReport& run) {
  json missing_conditions = json::array();
  for (const MissingCondition& missing : run.missing_conditions()) {
    missing_conditions.push_back(
        {{"condition", condition_name(missing.condition)}, {"reason", missing.reason}, {"cases", ids(missing.cases)}});
  }
  return missing_conditions;
}

json case_object(const CaseResult& result, const RunReport& run, const Device& sheet) {
  const CaseRow& row = *result.row;
  return {{"id", row.id},
          {"area", area_of(row).id},
          {"title", row.title},
          {"clause", row.clause},
          {"level", row_of(row.level).name},
          {"needs", permission_names(row.needs)},
          {"relies_on", condition_names(row.relies_on)},
          {"verdict", row_of(result.verdict).name},
          {"reason", text_or_null(result.reason)},
          {"condition", condition_name(result.condition)},
          {"expected", text_or_null(result.expected)},
          {"got", text_or_null(result.got)},
          {"rule", text_or_null(std::string{result.rule.text()})},
          {"deviation", text_or_null(result.deviation)},
          {"warnings", result.warnings},
          {"provokes", provoked_by(row.id)},
          {"not_restored", result.not_restored},
          {"began_us", result.began},
          {"took_us", result.took},
          {"lag_us", result.lag},
          {"repeat", repeat_command(run, row)},
          {"first_run", first_run_object(result, run, sheet)},
          {"failed_frames", result.failed_frames},
          {"frames", frame_objects(result.verdict_frames(), run.node, sheet)}};
}

/// Null for a device on a bus.
json composition_object(const RunReport& run) {
  if (!run.composition) return nullptr;
  return {{"made_by", run.composition->made_by_edsc ? "edsc" : "program"}, {"without", run.composition->omitted}};
}

json area_object(const AreaCount& count) {
  json object = {{"id", count.area->id}, {"title", count.area->title}};
  for (const VerdictRow& row : verdicts) {
    object[std::string{row.name}] = count.of_verdict[static_cast<std::size_t>(row.verdict)];
  }
  return object;
}

}  // namespace

json file_object(const InputFile& file) {
  if (file.path.empty()) return nullptr;
  return {{"file", file.path}, {"sha256", text_or_null(file.hash)}};
}

json frame_objects(std::span<const SeenFrame> frames, std::uint8_t node, const Device& sheet) {
  json objects = json::array();
  decode_frames(frames, node, sheet,
                [&](const SeenFrame& seen, const Message& message) { objects.push_back(frame_object(seen, message)); });
  return objects;
}

json run_object(const RunReport& run, const Device& sheet) {
  json totals = json::object();
  for (const VerdictRow& row : verdicts) totals[std::string{row.name}] = run.count(row.verdict);
  json areas = json::array();
  for (const AreaCount& count : count_by_area(run)) areas.push_back(area_object(count));
  json cases = json::array();
  for (const CaseResult& result : run.cases) cases.push_back(case_object(result, run, sheet));
  json report = {{"schema", 2},
                 {"edsc", run.version},
                 {"passed", run.passed()},
                 {"title", text_or_null(run.title)},
                 {"operator", text_or_null(run.operator_name)},
                 {"place", text_or_null(run.place)},
                 {"host", text_or_null(run.host)},
                 {"started", text_or_null(run.started == 0 ? "" : utc_text(run) + 'Z')},
                 {"bus", run.bus},
                 {"node_id", run.node},
                 {"eds",
                  {{"file", run.sheet},
                   {"sha256", text_or_null(run.sheet_hash)},
                   {"vendor", run.vendor},
                   {"product", run.product}}},
                 {"options", file_object(run.options_file)},
                 {"deviations", file_object(run.deviations_file)},
                 {"identity",
                  {{"read", text_or_null(run.read_identity)},
                   {"differences", text_or_null(run.identity)},
                   {"deviation", text_or_null(run.identity_deviation)}}},
                 {"composition", composition_object(run)},
                 {"level", row_of(run.level).name},
                 {"permissions", permission_names(run.permissions)},
                 {"seed", run.seed},
                 {"max_lag_us", max_lag(run)},
                 {"provokes", provoked_by("start")},
                 {"interrupted", run.interrupted},
                 {"ended_early", text_or_null(run.lost)},
                 {"unused_deviations", run.unused_deviations},
                 {"not_restored", run.not_restored},
                 {"verdicts", std::move(totals)},
                 {"causes", causes_array(run)},
                 {"missing_conditions", missing_conditions_array(run)},
                 {"areas", std::move(areas)},
                 {"cases", std::move(cases)}};
  return report;
}

std::string json_report(const RunReport& run, const Device& sheet) { return json_text(run_object(run, sheet)) + '\n'; }

}  // namespace edsc::conform
