#include "conform/report/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>

#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "conform/report/decoded_frames.hpp"
#include "conform/report/report_facts.hpp"
#include "decode/log/print_message.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"

namespace edsc::conform {
namespace {

using json = nlohmann::ordered_json;

/// Null for an empty text: the template omits the section.
json shown(const std::string& text) { return text.empty() ? json(nullptr) : json(text); }

std::string data_text(const canopen::Frame& frame) {
  if (frame.remote) return fmt::format("remote {}", frame.size);
  return hex_bytes(data_of(frame));
}

json frame_view(const SeenFrame& seen, const Message& message, bool is_named) {
  const bool received = !seen.sent && !message.problem;
  return {{"at", time_text(seen.at)},
          {"direction", direction_text(seen)},
          {"can_id", fmt::format("{:0{}X}", seen.frame.id, seen.frame.extended ? 8 : 3)},
          {"data", data_text(seen.frame)},
          {"service", service_label(message)},
          {"meaning", message.text},
          {"is_named", is_named},
          {"frame_class", message.problem ? "failed"
                          : received      ? "received"
                                          : "sent"}};
}

std::string frames_remark(std::size_t frames, bool are_named) {
  std::string text = are_named ? "marked: the frames that the failed check names" : "";
  if (frames <= max_html_frames) return text;
  const std::string hidden = counted(frames - max_html_frames, are_named ? "other frame" : "earlier frame");
  return fmt::format("{}{}{} not shown; --log writes all frames", text, text.empty() ? "" : "; ", hidden);
}

/// The note of a case whose details are closed.
std::string note_of(const CaseResult& result) {
  if (!result.deviation.empty()) return result.deviation;
  if (!result.reason.empty() || result.warnings.empty()) return result.reason;
  return "warning: " + result.warnings.front();
}

/// Adds the frames, if there are any, under a heading.
void add_frames(json& tables, std::string_view heading, std::span<const SeenFrame> frames,
                std::span<const std::size_t> named, const RunReport& run, const Device& sheet) {
  if (frames.empty()) return;
  tables.push_back({{"heading", heading},
                    {"remark", shown(frames_remark(frames.size(), !named.empty()))},
                    {"frames", frames_view(frames, run.node, sheet, named)}});
}

json case_link(const CaseResult* result) { return {{"id", result->row->id}}; }

json case_links(const std::vector<const CaseResult*>& cases) {
  json links = json::array();
  for (const CaseResult* result : cases) links.push_back(case_link(result));
  return links;
}

json causes_view(const RunReport& run) {
  json causes = json::array();
  for (const Cause& cause : run.causes()) causes.push_back({{"text", cause.text}, {"cases", case_links(cause.cases)}});
  return causes;
}

json conditions_view(const RunReport& run) {
  json view = json::array();
  for (const MissingCondition& missing : run.missing_conditions()) {
    view.push_back({{"text", condition_text(missing)}, {"cases", case_links(missing.cases)}});
  }
  return view;
}

json case_view(const CaseResult& result, const RunReport& run, const Device& sheet) {
  const CaseRow& row = *result.row;
  const bool ran = result.verdict != Verdict::not_run;
  json tables = json::array();
  if (result.first_run) {
    add_frames(tables, "first run", result.first_run->frames, result.first_run->failed_frames, run, sheet);
  }
  add_frames(tables, result.first_run ? "repetition" : "frames", result.verdict_frames(), result.failed_frames, run,
             sheet);
  return {{"id", row.id},
          {"title", row.title},
          {"verdict", row_of(result.verdict).name},
          {"verdict_text", row_of(result.verdict).text},
          {"took", shown(ran ? duration_text(result.took) : "")},
          {"open", result.verdict == Verdict::failed},
          {"note", shown(note_of(result))},
          {"clause", row.clause},
          {"expected", shown(result.expected)},
          {"got", shown(result.got)},
          {"rule", shown(std::string{result.rule.text()})},
          {"warnings", result.warnings},
          {"not_restored", result.not_restored},
          {"lag", duration_text(result.lag)},
          {"repeat", repeat_command(run, row)},
          {"first_run", shown(result.first_run ? first_run_text(*result.first_run) : "")},
          {"tables", std::move(tables)}};
}

json count_view(const VerdictRow& row, std::size_t count) {
  return {{"name", row.name},
          {"text", row.text},
          {"count", count},
          {"class", count == 0 ? "none" : fmt::format("some {}", row.name)}};
}

json area_view(const AreaCount& area, const RunReport& run, const Device& sheet) {
  json counts = json::array();
  for (const VerdictRow& row : verdicts) {
    counts.push_back(count_view(row, area.of_verdict[static_cast<std::size_t>(row.verdict)]));
  }
  json cases = json::array();
  for (const CaseResult& result : run.cases) {
    if (&area_of(*result.row) == area.area) cases.push_back(case_view(result, run, sheet));
  }
  return {{"area_id", area.area->id},
          {"area_title", area.area->title},
          {"case_count", area.cases},
          {"counts", std::move(counts)},
          {"cases", std::move(cases)}};
}

}  // namespace

json frames_view(std::span<const SeenFrame> seen_frames, std::uint8_t node, const Device& sheet,
                 std::span<const std::size_t> named) {
  const std::vector<std::size_t> shown = shown_frames(seen_frames.size(), named, max_html_frames);
  json frames = json::array();
  std::size_t position = 0;
  auto next = shown.begin();
  decode_frames(seen_frames, node, sheet, [&](const SeenFrame& seen, const Message& message) {
    const std::size_t present = position++;
    if (next == shown.end() || *next != present) return;
    ++next;
    frames.push_back(frame_view(seen, message, std::ranges::find(named, present) != named.end()));
  });
  return frames;
}

json run_view(const RunReport& run, const Device& sheet) {
  const std::vector<std::string> problems = run_problems(run);
  json totals = json::array();
  json filters = json::array();
  for (const VerdictRow& row : verdicts) {
    totals.push_back(count_view(row, run.count(row.verdict)));
    if (run.count(row.verdict) > 0) filters.push_back(totals.back());
  }
  json areas = json::array();
  for (const AreaCount& area : count_by_area(run)) areas.push_back(area_view(area, run, sheet));
  return {{"result", run.passed() ? "passed" : "failed"},
          {"sentence", verdict_sentence(run)},
          {"has_problems", !problems.empty()},
          {"problems", problems},
          {"title", shown(run.title)},
          {"date", shown(local_time_text(run))},
          {"operator", shown(run.operator_name)},
          {"place", shown(run.place)},
          {"host", shown(run.host)},
          {"causes_sentence", shown(causes_sentence(run))},
          {"causes", causes_view(run)},
          {"has_conditions", !run.missing_conditions().empty()},
          {"conditions", conditions_view(run)},
          {"product", run.product.empty() ? fmt::format("node {}", run.node) : run.product},
          {"vendor", shown(run.vendor)},
          {"identity", shown(run.read_identity)},
          {"differences", shown(identity_sentence(run))},
          {"differences_class", run.identity_deviation.empty() ? "differs" : "deviates"},
          {"sheet", run.sheet},
          {"sheet_hash", shown(run.sheet_hash)},
          {"options_file", shown(run.options_file.path)},
          {"options_hash", shown(run.options_file.hash)},
          {"deviations_file", shown(run.deviations_file.path)},
          {"deviations_hash", shown(run.deviations_file.hash)},
          {"node", run.node},
          {"bus", run.bus},
          {"composition", shown(composition_text(run))},
          {"level", level_text(run)},
          {"seed", run.seed},
          {"max_lag", duration_text(max_lag(run))},
          {"version", run.version},
          {"all_count", run.cases.size()},
          {"verdicts", totals},
          {"totals", totals},
          {"filters", filters},
          {"areas", std::move(areas)}};
}

std::string html_report(const RunReport& run, const Device& sheet) {
  return render_html(with_parts("conform.html"), run_view(run, sheet));
}

}  // namespace edsc::conform
