#include "conform/report/json_report.hpp"

#include <nlohmann/json.hpp>

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

json case_object(const CaseResult& result, const RunReport& run, const Device& sheet) {
  const CaseRow& row = *result.row;
  json frames = json::array();
  decode_frames(result, run.node, sheet,
                [&](const SeenFrame& seen, const Message& message) { frames.push_back(frame_object(seen, message)); });
  return {{"id", row.id},
          {"area", area_of(row).id},
          {"title", row.title},
          {"clause", row.clause},
          {"level", row_of(row.level).name},
          {"needs", permission_names(row.needs)},
          {"verdict", row_of(result.verdict).name},
          {"reason", text_or_null(result.reason)},
          {"expected", text_or_null(result.expected)},
          {"got", text_or_null(result.got)},
          {"rule", text_or_null(std::string{result.rule.text()})},
          {"deviation", text_or_null(result.deviation)},
          {"warnings", result.warnings},
          {"not_put_back", result.not_put_back},
          {"began_us", result.began},
          {"took_us", result.took},
          {"lag_us", result.lag},
          {"repeat", repeat_command(run, row)},
          {"frames", std::move(frames)}};
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

std::string json_report(const RunReport& run, const Device& sheet) {
  json totals = json::object();
  for (const VerdictRow& row : verdicts) totals[std::string{row.name}] = run.count(row.verdict);
  json areas = json::array();
  for (const AreaCount& count : count_by_area(run)) areas.push_back(area_object(count));
  json cases = json::array();
  for (const CaseResult& result : run.cases) cases.push_back(case_object(result, run, sheet));
  const json report = {
      {"version", 1},
      {"edsc", run.version},
      {"passed", run.passed()},
      {"bus", run.bus},
      {"node_id", run.node},
      {"eds",
       {{"file", run.sheet},
        {"sha256", text_or_null(run.sheet_hash)},
        {"vendor", run.vendor},
        {"product", run.product}}},
      {"identity", {{"read", text_or_null(run.read_identity)}, {"differences", text_or_null(run.identity)}}},
      {"composition", composition_object(run)},
      {"level", row_of(run.level).name},
      {"permissions", permission_names(run.permissions)},
      {"seed", run.seed},
      {"max_lag_us", max_lag(run)},
      {"interrupted", run.interrupted},
      {"ended_early", text_or_null(run.lost)},
      {"unused_deviations", run.unused_deviations},
      {"not_put_back", run.not_put_back},
      {"verdicts", std::move(totals)},
      {"areas", std::move(areas)},
      {"cases", std::move(cases)}};
  return json_text(report) + '\n';
}

}  // namespace edsc::conform
