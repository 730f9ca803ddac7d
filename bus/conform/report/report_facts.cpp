#include "conform/report/report_facts.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <iterator>

#include "text/counted.hpp"

namespace edsc::conform {

std::vector<AreaCount> count_by_area(const RunReport& run) {
  std::vector<AreaCount> counts;
  for (const CaseResult& result : run.cases) {
    const AreaRow& area = area_of(*result.row);
    auto found = std::ranges::find(counts, &area, &AreaCount::area);
    if (found == counts.end()) found = counts.insert(found, AreaCount{&area});
    ++found->of_verdict[static_cast<std::size_t>(result.verdict)];
    ++found->cases;
  }
  return counts;
}

std::uint64_t max_lag(const RunReport& run) {
  std::uint64_t lag = 0;
  for (const CaseResult& result : run.cases) lag = std::max(lag, result.lag);
  return lag;
}

std::string level_text(const RunReport& run) {
  std::string text = fmt::format("level {}", row_of(run.level).name);
  std::string_view separator = " with ";
  if (run.level >= Level::all) return text;
  for (const std::string_view name : permission_names(run.permissions)) {
    text.append(separator).append(name);
    separator = " and ";
  }
  return text;
}

std::string composition_text(const RunReport& run) {
  if (!run.composition) return {};
  if (run.composition->made_by_edsc) return "made by edsc, with all parts that the EDS promises";
  std::string text = "of the program";
  std::string_view separator = ", without ";
  for (const std::string& part : run.composition->omitted) {
    text.append(separator).append(part == "lss" ? "LSS" : part);
    separator = ", ";
  }
  return text;
}

std::string identity_sentence(const RunReport& run) {
  if (run.identity_deviation.empty()) return run.identity;
  return fmt::format("{}; declared: {}", run.identity, run.identity_deviation);
}

std::vector<std::string> run_problems(const RunReport& run) {
  std::vector<std::string> problems;
  for (const std::string& unused : run.unused_deviations)
    problems.push_back(fmt::format("unused deviation: {}", unused));
  for (const std::string& left : run.not_restored) problems.push_back(fmt::format("not restored: {}", left));
  if (run.interrupted) problems.emplace_back("the run was interrupted");
  if (!run.lost.empty()) problems.push_back(fmt::format("the run ended early: {}", run.lost));
  return problems;
}

std::string result_sentence(const RunReport& run) {
  if (run.cases.empty()) return "no case ran";
  const std::size_t failed = run.count(Verdict::failed);
  const std::string cases = counted(run.cases.size(), "case");
  std::string text =
      failed == 0 ? fmt::format("none of {} failed", cases) : fmt::format("{} of {} failed", failed, cases);
  std::string_view separator = "; ";
  for (const VerdictRow& row : verdicts) {
    const std::size_t count = run.count(row.verdict);
    if (count == 0 || row.verdict == Verdict::failed) continue;
    const bool plural = row.verdict == Verdict::deviates && count > 1;
    fmt::format_to(std::back_inserter(text), "{}{} {}", separator, count, plural ? "deviate as declared" : row.text);
    separator = ", ";
  }
  return text;
}

std::string verdict_sentence(const RunReport& run) {
  std::string result = result_sentence(run);
  const std::vector<std::string> problems = run_problems(run);
  if (problems.empty() || run.count(Verdict::failed) > 0) return result;
  const std::string more =
      problems.size() == 1 ? "" : fmt::format(", and {}", counted(problems.size() - 1, "other problem"));
  return fmt::format("{}{}; {}", problems.front(), more, result);
}

std::string coverage_text(const RunReport& run) {
  const std::size_t all = all_cases().size();
  if (run.cases.size() >= all && run.count(Verdict::not_run) == 0) return {};
  const std::size_t ran = run.cases.size() - run.count(Verdict::not_run) - run.count(Verdict::not_applicable);
  return fmt::format("{}: {} of {} cases run", level_text(run), ran, all);
}

std::string causes_sentence(const RunReport& run) {
  const std::size_t failed = run.count(Verdict::failed);
  if (failed == 0) return {};
  return fmt::format("{}, {}", counted(failed, "failed case"), counted(run.causes().size(), "cause"));
}

std::string case_ids(const std::vector<const CaseResult*>& cases) {
  std::string text;
  for (const CaseResult* result : cases) text.append(text.empty() ? "" : ", ").append(result->row->id);
  return text;
}

std::string condition_text(const MissingCondition& missing) {
  const auto row = std::ranges::find(conditions, missing.condition, &ConditionRow::condition);
  return fmt::format("{}: {}", row->text, missing.reason);
}

std::string local_time_text(const RunReport& run) {
  if (run.started == 0) return {};
  return fmt::format("{:%Y-%m-%d %H:%M:%S %z}", fmt::localtime(static_cast<std::time_t>(run.started)));
}

std::string utc_text(const RunReport& run) {
  if (run.started == 0) return {};
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(run.started)));
}

std::string first_run_text(const FirstRun& first) {
  return fmt::format("expected {}; got {}", first.expected, first.got);
}

std::vector<std::string_view> permission_names(Permission permissions) {
  std::vector<std::string_view> names;
  for (const PermissionRow& row : permission_options) {
    if (includes(permissions, row.permission)) names.push_back(row.option.substr(row.option.find_first_not_of('-')));
  }
  return names;
}

std::string message_of(const CaseResult& result) {
  if (result.verdict == Verdict::failed) {
    std::string text = fmt::format("expected {}; got {}", result.expected, result.got);
    if (!result.rule.text().empty())
      text += fmt::format("; rule {} of edsc check reports it in the EDS", result.rule.text());
    return text;
  }
  const std::string_view text = row_of(result.verdict).text;
  const std::string& reason = result.verdict == Verdict::deviates ? result.deviation : result.reason;
  return reason.empty() ? std::string{text} : fmt::format("{}: {}", text, reason);
}

std::string time_text(std::uint64_t microseconds) {
  return fmt::format("{}.{:06}", microseconds / 1'000'000, microseconds % 1'000'000);
}

std::string duration_text(std::uint64_t microseconds) {
  if (microseconds < 1'000'000) return fmt::format("{:.1f} ms", static_cast<double>(microseconds) / 1e3);
  return fmt::format("{:.3f} s", static_cast<double>(microseconds) / 1e6);
}

}  // namespace edsc::conform
