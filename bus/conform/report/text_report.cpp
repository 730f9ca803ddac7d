#include "conform/report/text_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "conform/cases/shared/entry_values.hpp"
#include "conform/report/decoded_frames.hpp"
#include "conform/report/report_facts.hpp"
#include "text/printable.hpp"

namespace edsc::conform {
namespace {

constexpr std::string_view no_color = "\x1b[0m";
constexpr std::size_t id_width = 7, verdict_width = 22;

std::string_view color_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed: return "\x1b[32m";
    case Verdict::failed: return "\x1b[1;31m";
    case Verdict::deviates: return "\x1b[33m";
    case Verdict::inconclusive: return "\x1b[35m";
    case Verdict::not_applicable:
    case Verdict::not_run: return "\x1b[2m";
  }
  return {};
}

/// `text` in the colour, if there is one, padded with blanks to the width.
std::string colored(std::string_view text, std::string_view color, std::size_t width = 0) {
  const std::size_t blanks = width - std::min(width, text.size());
  if (color.empty()) return fmt::format("{}{:{}}", text, "", blanks);
  return fmt::format("{}{}{}{:{}}", color, text, no_color, "", blanks);
}

std::string counted_cases(const std::vector<const CaseResult*>& cases) {
  return fmt::format("{} {}", cases.size() == 1 ? "case" : "cases", case_ids(cases));
}

/// Appends a detail line, unless the text is empty.
void append_detail(std::string& out, std::string_view name, std::string_view text) {
  if (text.empty()) return;
  fmt::format_to(std::back_inserter(out), "{:{}}{:<13} {}\n", "", id_width, name, printable(text));
}

void append_file(std::string& out, std::string_view name, const InputFile& file) {
  append_detail(out, name, file.path.empty() ? "none" : file.path);
  append_detail(out, "SHA-256", file.hash);
}

}  // namespace

std::string TextReport::head() const {
  std::string out;
  const std::string device = run_.vendor.empty() ? run_.product : fmt::format("{}, {}", run_.product, run_.vendor);
  append_detail(out, "title", run_.title);
  append_detail(out, "date", local_time_text(run_));
  append_detail(out, "operator", run_.operator_name);
  append_detail(out, "place", run_.place);
  append_detail(out, "device", device);
  append_detail(out, "EDS", run_.sheet);
  append_detail(out, "SHA-256", run_.sheet_hash);
  append_file(out, "options", run_.options_file);
  append_file(out, "deviations", run_.deviations_file);
  append_detail(out, "node", fmt::format("{} on {}", run_.node, run_.bus));
  append_detail(out, "composition", composition_text(run_));
  append_detail(out, "test", fmt::format("{}, seed {}, edsc {}", level_text(run_), run_.seed, run_.version));
  return out;
}

std::string TextReport::application_objects() const {
  constexpr std::size_t width = 90;
  if (!includes(run_.permissions, Permission::application) || run_.level == Level::read) return {};
  std::string out, line;
  std::string_view name = "writes";
  const auto end_line = [&] {
    append_detail(out, name, line);
    name = "";
    line.clear();
  };
  for (const Object& object : sheet_.objects) {
    const auto is_written = [&](const Entry& entry) {
      return is_application_parameter(sheet_, live_entry(sheet_, object, entry));
    };
    if (std::ranges::none_of(object.entries, is_written)) continue;
    const std::string text = fmt::format("{:04X}h {}", object.index, object.name);
    if (!line.empty() && line.size() + text.size() > width) end_line();
    line += (line.empty() ? "" : ", ") + text;
  }
  end_line();
  return out;
}

std::string TextReport::of(const CaseResult& result) const {
  const CaseRow& row = *result.row;
  const VerdictRow& verdict = row_of(result.verdict);
  std::string out =
      fmt::format("{:<{}}{}{}", row.id, id_width,
                  colored(verdict.text, color_ ? color_of(result.verdict) : "", verdict_width), row.title);
  if (!result.reason.empty()) fmt::format_to(std::back_inserter(out), " ({})", printable(result.reason));
  out += '\n';
  append_detail(out, "reason", result.deviation);
  for (const std::string& warning : result.warnings) append_detail(out, "warning", warning);
  for (const std::string& left : result.not_restored) append_detail(out, "not restored", left);
  if (result.first_run)
    append_frames(out, "first run", first_run_text(*result.first_run), result.first_run->frames,
                  result.first_run->failed_frames);
  if (result.verdict != Verdict::failed) return out;
  append_detail(out, "clause", row.clause);
  append_detail(out, "expected", result.expected);
  append_detail(out, "got", result.got);
  if (!result.rule.text().empty())
    append_detail(out, "EDS", fmt::format("rule {} of edsc check reports it", result.rule.text()));
  append_frames(out, "", "", result.verdict_frames(), result.failed_frames);
  append_detail(out, "repeat with", repeat_command(run_, row));
  return out;
}

void TextReport::append_frames(std::string& out, std::string_view name, std::string_view text,
                               std::span<const SeenFrame> frames, std::span<const std::size_t> named) const {
  append_detail(out, name, text);
  name = "frames";
  for (const std::string& line : frame_lines(frames, run_.node, sheet_, max_frames, named)) {
    append_detail(out, name, line);
    name = "";
  }
}

std::string TextReport::table() const {
  const std::vector<AreaCount> areas = count_by_area(run_);
  std::vector<const VerdictRow*> columns;
  for (const VerdictRow& row : verdicts) {
    const bool always = row.verdict == Verdict::passed || row.verdict == Verdict::failed;
    if (always || run_.count(row.verdict) > 0) columns.push_back(&row);
  }
  std::size_t width = std::string_view{"all"}.size();
  for (const AreaCount& count : areas) width = std::max(width, count.area->title.size());

  std::string out = fmt::format("\n{:<{}}{:<{}}  cases", "area", id_width, "", width);
  for (const VerdictRow* column : columns) fmt::format_to(std::back_inserter(out), "  {}", column->text);
  out += '\n';
  const auto append_row = [&](std::string_view id, std::string_view title, std::size_t cases, const auto& count_of) {
    fmt::format_to(std::back_inserter(out), "{:<{}}{:<{}}  {:>5}", id, id_width, title, width, cases);
    for (const VerdictRow* column : columns) {
      fmt::format_to(std::back_inserter(out), "  {:>{}}", count_of(column->verdict), column->text.size());
    }
    out += '\n';
  };
  for (const AreaCount& count : areas) {
    append_row(count.area->id, count.area->title, count.cases,
               [&](Verdict verdict) { return count.of_verdict[static_cast<std::size_t>(verdict)]; });
  }
  append_row("", "all", run_.cases.size(), [&](Verdict verdict) { return run_.count(verdict); });
  return out;
}

std::string TextReport::summary() const {
  std::string out = run_.cases.empty() ? std::string{} : table();
  out += '\n';
  if (!run_.read_identity.empty()) append_detail(out, "identity", run_.read_identity);
  append_detail(out, "differs", identity_sentence(run_));
  append_detail(out, "causes", causes_sentence(run_));
  for (const Cause& cause : run_.causes()) {
    append_detail(out, "cause", cause.text);
    if (cause.cases.size() > 1) append_detail(out, "", counted_cases(cause.cases));
  }
  for (const MissingCondition& missing : run_.missing_conditions()) {
    append_detail(out, "inconclusive", condition_text(missing));
    append_detail(out, "", counted_cases(missing.cases));
  }
  append_detail(out, "test lag", fmt::format("{} at most", duration_text(max_lag(run_))));
  for (const std::string& problem : run_problems(run_)) append_detail(out, "problem", problem);
  const bool passed = run_.passed();
  const std::string_view color = color_of(passed ? Verdict::passed : Verdict::failed);
  fmt::format_to(std::back_inserter(out), "{}: {}\n", colored(passed ? "passed" : "failed", color_ ? color : ""),
                 verdict_sentence(run_));
  return out;
}

}  // namespace edsc::conform
