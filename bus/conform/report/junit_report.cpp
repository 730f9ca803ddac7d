#include "conform/report/junit_report.hpp"

#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "conform/report/decoded_frames.hpp"
#include "conform/report/report_facts.hpp"
#include "text/printable.hpp"

namespace edsc::conform {
namespace {

constexpr std::size_t max_junit_frames = 100;

/// XML 1.0 does not allow most control characters, not even escaped.
void set(pugi::xml_node node, const char* name, std::string_view text) {
  node.append_attribute(name) = printable(text).c_str();
}

void set_count(pugi::xml_node node, const char* name, std::size_t count) {
  node.append_attribute(name) = static_cast<unsigned long long>(count);
}

void set_time(pugi::xml_node node, std::uint64_t microseconds) { set(node, "time", time_text(microseconds)); }

/// The text of an element, one line each.
void set_lines(pugi::xml_node node, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += printable(line) + '\n';
  node.append_child(pugi::node_pcdata).set_value(text.c_str());
}

/// Texts of a result with any verdict.
void add_remarks(pugi::xml_node test, const CaseResult& result, const RunReport& run, const Device& sheet) {
  std::vector<std::string> lines;
  for (const std::string& warning : result.warnings) lines.push_back("warning: " + warning);
  for (const std::string& left : result.not_restored) lines.push_back("not restored: " + left);
  if (result.first_run) {
    lines.push_back("first run: " + first_run_text(*result.first_run));
    const std::vector<std::string> frames =
        frame_lines(result.first_run->frames, run.node, sheet, max_junit_frames, result.first_run->failed_frames);
    lines.insert(lines.end(), frames.begin(), frames.end());
  }
  if (!lines.empty()) set_lines(test.append_child("system-out"), lines);
}

void add_failure(pugi::xml_node test, const CaseResult& result, const RunReport& run, const Device& sheet) {
  pugi::xml_node failure = test.append_child("failure");
  set(failure, "message", message_of(result));
  set(failure, "type", result.row->clause);
  std::vector<std::string> lines = {fmt::format("clause: {}", result.row->clause),
                                    fmt::format("expected: {}", result.expected), fmt::format("got: {}", result.got)};
  const std::vector<std::string> frames =
      frame_lines(result.verdict_frames(), run.node, sheet, max_junit_frames, result.failed_frames);
  lines.insert(lines.end(), frames.begin(), frames.end());
  lines.push_back(fmt::format("repeat with: {}", repeat_command(run, *result.row)));
  set_lines(failure, lines);
}

void add_case(pugi::xml_node suite, const CaseResult& result, const RunReport& run, const Device& sheet) {
  pugi::xml_node test = suite.append_child("testcase");
  set(test, "classname", fmt::format("conform.{}", area_of(*result.row).title));
  set(test, "name", fmt::format("{} {}", result.row->id, result.row->title));
  set_time(test, result.took);
  if (result.verdict == Verdict::failed) {
    add_failure(test, result, run, sheet);
  } else if (result.verdict != Verdict::passed) {
    set(test.append_child("skipped"), "message", message_of(result));
  }
  add_remarks(test, result, run, sheet);
}

/// When and where the run began.
void set_origin(pugi::xml_node suite, const RunReport& run) {
  if (run.started != 0) set(suite, "timestamp", utc_text(run));
  if (!run.host.empty()) set(suite, "hostname", run.host);
}

struct SuiteCounts {
  std::size_t tests = 0, failures = 0, skipped = 0;
  std::uint64_t took = 0;
};

void set_counts(pugi::xml_node node, const SuiteCounts& counts) {
  set_count(node, "tests", counts.tests);
  set_count(node, "failures", counts.failures);
  set_count(node, "errors", 0);
  set_count(node, "skipped", counts.skipped);
  set_time(node, counts.took);
}

SuiteCounts counts_of(const AreaCount& count, const RunReport& run) {
  const auto of = [&](Verdict verdict) { return count.of_verdict[static_cast<std::size_t>(verdict)]; };
  SuiteCounts counts{count.cases, of(Verdict::failed), 0, 0};
  counts.skipped = count.cases - counts.failures - of(Verdict::passed);
  for (const CaseResult& result : run.cases) {
    if (&area_of(*result.row) == count.area) counts.took += result.took;
  }
  return counts;
}

void add_area(pugi::xml_node suites, const AreaCount& count, const RunReport& run, const Device& sheet) {
  pugi::xml_node suite = suites.append_child("testsuite");
  set(suite, "name", fmt::format("{} {}", count.area->id, count.area->title));
  set_origin(suite, run);
  set_counts(suite, counts_of(count, run));
  for (const CaseResult& result : run.cases) {
    if (&area_of(*result.row) == count.area) add_case(suite, result, run, sheet);
  }
}

void add_properties(pugi::xml_node suite, const RunReport& run) {
  const std::pair<const char*, std::string> rows[] = {
      {"bus", run.bus},
      {"node", fmt::format("{}", run.node)},
      {"eds", run.sheet},
      {"eds_sha256", run.sheet_hash},
      {"options", run.options_file.path.empty() ? "none" : run.options_file.path},
      {"options_sha256", run.options_file.hash},
      {"deviations", run.deviations_file.path.empty() ? "none" : run.deviations_file.path},
      {"deviations_sha256", run.deviations_file.hash},
      {"vendor", run.vendor},
      {"product", run.product},
      {"identity", run.read_identity},
      {"identity_differences", identity_sentence(run)},
      {"composition", composition_text(run)},
      {"test", level_text(run)},
      {"seed", fmt::format("{}", run.seed)},
      {"max_lag", duration_text(max_lag(run))},
      {"edsc", run.version},
      {"title", run.title},
      {"operator", run.operator_name},
      {"place", run.place},
      {"causes", causes_sentence(run)},
  };
  pugi::xml_node properties = suite.append_child("properties");
  for (const auto& [name, value] : rows) {
    if (value.empty()) continue;
    pugi::xml_node property = properties.append_child("property");
    set(property, "name", name);
    set(property, "value", value);
  }
  for (const Cause& cause : run.causes()) {
    pugi::xml_node property = properties.append_child("property");
    set(property, "name", "cause");
    set(property, "value", fmt::format("{} (cases {})", cause.text, case_ids(cause.cases)));
  }
  for (const MissingCondition& missing : run.missing_conditions()) {
    pugi::xml_node property = properties.append_child("property");
    set(property, "name", "inconclusive");
    set(property, "value", fmt::format("{} (cases {})", condition_text(missing), case_ids(missing.cases)));
  }
}

/// A requirement on the run as a whole.
struct RunCheck {
  const char* name;
  std::vector<std::string> problems;
};

std::vector<RunCheck> run_checks(const RunReport& run) {
  std::vector<RunCheck> checks = {{"all changed values are restored", run.not_restored},
                                  {"each declared deviation occurs", run.unused_deviations},
                                  {"the run is complete", {}}};
  if (run.interrupted) checks.back().problems.emplace_back("interrupted");
  if (!run.lost.empty()) checks.back().problems.push_back(run.lost);
  return checks;
}

SuiteCounts add_run(pugi::xml_node suites, const RunReport& run) {
  SuiteCounts counts;
  pugi::xml_node suite = suites.append_child("testsuite");
  set(suite, "name", "run");
  set_origin(suite, run);
  const std::vector<RunCheck> checks = run_checks(run);
  counts.tests = checks.size();
  for (const RunCheck& check : checks) counts.failures += check.problems.empty() ? 0 : 1;
  set_counts(suite, counts);
  add_properties(suite, run);
  for (const RunCheck& check : checks) {
    pugi::xml_node test = suite.append_child("testcase");
    set(test, "classname", "conform.run");
    set(test, "name", check.name);
    set_time(test, 0);
    if (check.problems.empty()) continue;
    pugi::xml_node failure = test.append_child("failure");
    set(failure, "message", check.problems.front());
    set_lines(failure, check.problems);
  }
  return counts;
}

}  // namespace

std::string junit_report(const RunReport& run, const Device& sheet) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node suites = document.append_child("testsuites");
  set(suites, "name", "edsc conform");
  SuiteCounts all = add_run(suites, run);
  for (const AreaCount& count : count_by_area(run)) {
    const SuiteCounts counts = counts_of(count, run);
    all = {all.tests + counts.tests, all.failures + counts.failures, all.skipped + counts.skipped,
           all.took + counts.took};
    add_area(suites, count, run, sheet);
  }
  set_counts(suites, all);
  std::ostringstream out;
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(out).str();
}

}  // namespace edsc::conform
