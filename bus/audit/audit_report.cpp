#include "audit/audit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "audit/cycle_report.hpp"
#include "audit/network_times_report.hpp"
#include "backend/render.hpp"
#include "backend/template_parts.hpp"
#include "device/device.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "values/append.hpp"

namespace edsc::audit {
namespace {

using json = nlohmann::ordered_json;

/// The findings in their order, each with the one from which it follows.
struct Grouped {
  explicit Grouped(const Report& report)
      : findings{report.findings->in_order()}, causes{report.incidents->causes_of(findings)} {}

  [[nodiscard]] std::size_t count_causes(Severity severity) const {
    std::size_t count = 0;
    for (std::size_t at = 0; at < findings.size(); ++at) {
      if (!causes[at] && findings[at]->subject.rule.row().severity == severity) ++count;
    }
    return count;
  }
  [[nodiscard]] std::size_t count_following() const {
    return static_cast<std::size_t>(std::ranges::count_if(causes, [](const auto& cause) { return cause.has_value(); }));
  }
  /// The places of the findings that follow from this one.
  [[nodiscard]] std::vector<std::size_t> following(std::size_t cause) const {
    std::vector<std::size_t> places;
    for (std::size_t at = 0; at < causes.size(); ++at) {
      if (causes[at] == cause) places.push_back(at);
    }
    return places;
  }

  std::vector<const Finding*> findings;
  std::vector<std::optional<std::size_t>> causes;
};

/// `3 findings follow from this: heartbeat-late (2), sdo-timeout`; empty without one.
std::string following_text(const Grouped& grouped, std::size_t cause) {
  const std::vector<std::size_t> places = grouped.following(cause);
  if (places.empty()) return {};
  std::map<std::string_view, std::size_t> rules;
  for (const std::size_t at : places) ++rules[grouped.findings[at]->subject.rule.text()];
  std::string text = places.size() == 1 ? "1 finding follows" : fmt::format("{} findings follow", places.size());
  text += " from this: ";
  bool is_first = true;
  for (const auto& [rule, count] : rules) {
    text += fmt::format("{}{}", std::exchange(is_first, false) ? "" : ", ", rule);
    if (count > 1) text += fmt::format(" ({})", count);
  }
  return text;
}

/// The network has a bit rate, and the log times.
bool has_network_times(const Report& report) {
  return report.network_times != nullptr && report.totals.has_times && !report.network_times->messages().empty();
}

/// `1.234567 s`
std::string time_text(const Moment& moment) {
  if (!moment.has_time) return {};
  return fmt::format("{}.{:06} s", moment.us / 1'000'000, moment.us % 1'000'000);
}

/// `node 5 axis1, 1800h:05 TPDO communication parameter`
std::string subject_text(const Finding& finding, const Report& report) {
  const Subject& subject = finding.subject;
  std::string text;
  if (subject.node_id != 0) {
    text = fmt::format("node {}", unsigned{subject.node_id});
    if (const std::string_view name = report.labels->name(subject.node_id); !name.empty())
      text += fmt::format(" {}", name);
  }
  const auto separate = [&text] { text += text.empty() ? "" : ", "; };
  const bool has_can_id = subject.can_id != 0 && subject.rule != AuditRule{"sdo-abort"};
  if (has_can_id) {
    separate();
    text += fmt::format("CAN-ID {:0{}X}h", subject.can_id, subject.extended ? 8 : 3);
  }
  if (subject.index == 0) return text.empty() ? "bus" : text;
  separate();
  const bool is_tpdo = subject.index >= 0x1800 && subject.index < 0x1A00;
  const bool is_rpdo = subject.index >= 0x1400 && subject.index < 0x1600;
  if (is_tpdo || is_rpdo) {
    return text + fmt::format("{}PDO {}", is_tpdo ? 'T' : 'R', subject.index - (is_tpdo ? 0x1800 : 0x1400) + 1);
  }
  append_entry_label(text, subject.index, subject.sub_index);
  const NodeModel* const model = report.decoder->find_model(subject.node_id);
  const Object* const object = model != nullptr ? model->device().find(subject.index) : nullptr;
  return object != nullptr ? fmt::format("{} {}", text, object->name) : text;
}

std::string occurrence_text(const Finding& finding) {
  if (finding.count == 1) return finding.first.has_time ? "at " + time_text(finding.first) : std::string{};
  std::string text = counted(finding.count, "time");
  if (finding.first.has_time) text += ", first at " + time_text(finding.first);
  if (finding.worst.line == finding.first.line) return text;
  text += fmt::format(", the shown one in line {}", finding.worst.line);
  if (finding.worst.has_time) text += " at " + time_text(finding.worst);
  return text;
}

std::string load_text(const Report& report) {
  if (report.limits.bit_rate == 0) return {};
  const Totals& totals = report.totals;
  return fmt::format(", load {}.{} %, at most {}.{} % over 100 ms", totals.mean_load / 10, totals.mean_load % 10,
                     totals.max_load / 10, totals.max_load % 10);
}

/// `12,345 frames of 3 nodes in 60.5 s, load 12.3 %, ...`
std::string totals_text(const Report& report) {
  const Totals& totals = report.totals;
  const std::string nodes = counted(totals.nodes, "node");
  if (!totals.has_times) {
    return fmt::format("{} of {}, without times: cycles and delays were not checked", counted(totals.frames, "frame"),
                       nodes);
  }
  return fmt::format("{} of {} in {}.{:03} s{}", counted(totals.frames, "frame"), nodes, totals.duration_us / 1'000'000,
                     totals.duration_us / 1000 % 1000, load_text(report));
}

std::string verdict_text(const Report& report) {
  const Findings& findings = *report.findings;
  const Grouped grouped{report};
  if (grouped.findings.empty()) return "no findings";
  std::string text = fmt::format("{}, {}, {}", counted(grouped.count_causes(Severity::error), "error"),
                                 counted(grouped.count_causes(Severity::warning), "warning"),
                                 counted(grouped.count_causes(Severity::note), "note"));
  if (const std::size_t following = grouped.count_following(); following > 0) {
    text += fmt::format("; {} from these",
                        following == 1 ? "1 finding follows" : fmt::format("{} findings follow", following));
  }
  if (findings.not_listed() > 0) text += fmt::format(", {} not listed", counted(findings.not_listed(), "occurrence"));
  return text;
}

/// `by case 2.17: sdo-toggle; sdo-abort, 3 times`, for each case.
std::vector<std::string> provoked_texts(const Findings& findings) {
  std::vector<std::string> texts;
  const ProvokingCase* last = nullptr;
  for (const Provoked& one : findings.provoked()) {
    const std::string& id = one.by->id;
    if (one.by != last) texts.push_back((id.empty() ? "before the first case" : "by case " + printable(id)) + ": ");
    std::string& text = texts.back();
    text += fmt::format("{}{}", one.by == last ? "; " : "", one.rule.text());
    if (one.count > 1) text += ", " + counted(one.count, "time");
    last = one.by;
  }
  return texts;
}

std::string_view color_of(Severity severity) {
  switch (severity) {
    case Severity::error: return "\033[1;31m";
    case Severity::warning: return "\033[1;35m";
    case Severity::note: break;
  }
  return "\033[1;36m";
}

json moment_object(const Moment& moment) {
  return {{"line", moment.line}, {"at_us", moment.has_time ? json(moment.us) : json(nullptr)}};
}

json finding_object(const Finding& finding, const Report& report) {
  const Rule& rule = finding.subject.rule.row();
  const Subject& subject = finding.subject;
  const bool has_can_id = subject.can_id != 0 && subject.rule != AuditRule{"sdo-abort"};
  const auto or_null = [](bool has, auto value) { return has ? json(value) : json(nullptr); };
  return {{"rule", rule.id},
          {"severity", to_string(rule.severity)},
          {"node_id", or_null(subject.node_id != 0, unsigned{subject.node_id})},
          {"index", or_null(subject.index != 0, entry_label(subject.index, subject.sub_index))},
          {"can_id", or_null(has_can_id, subject.can_id)},
          {"abort_code", or_null(subject.rule == AuditRule{"sdo-abort"}, subject.can_id)},
          {"subject", printable(subject_text(finding, report))},
          {"meaning", rule.title},
          {"source", rule.source},
          {"expected", printable(finding.expected)},
          {"seen", printable(finding.seen)},
          {"count", finding.count},
          {"first", moment_object(finding.first)},
          {"shown", moment_object(finding.worst)}};
}

}  // namespace

bool Report::is_clean() const {
  return findings->count(Severity::error) == 0 && findings->count(Severity::warning) == 0;
}

namespace {

std::string finding_text(const Finding& finding, const Report& report, bool color) {
  const Rule& rule = finding.subject.rule.row();
  const std::string_view begin = color ? color_of(rule.severity) : std::string_view{};
  std::string text =
      fmt::format("{}:{}: {}{}:{} {}: {} [{}]\n    expected {}; seen: {}", printable(report.log), finding.first.line,
                  begin, to_string(rule.severity), color ? "\033[0m" : "", printable(subject_text(finding, report)),
                  rule.title, rule.id, printable(finding.expected), printable(finding.seen));
  if (const std::string occurrence = occurrence_text(finding); !occurrence.empty()) text += "; " + occurrence;
  return text + '\n';
}

}  // namespace

std::string text_report(const Report& report, bool color) {
  std::string text;
  const Grouped grouped{report};
  for (std::size_t at = 0; at < grouped.findings.size(); ++at) {
    if (grouped.causes[at]) continue;
    text += finding_text(*grouped.findings[at], report, color);
    const std::string following = following_text(grouped, at);
    if (following.empty()) continue;
    text += fmt::format("    {}{}\n", following, report.shows_all ? "" : "; --all-findings lists them");
    if (!report.shows_all) continue;
    for (const std::size_t one : grouped.following(at)) text += finding_text(*grouped.findings[one], report, color);
  }
  for (const std::string& provoked : provoked_texts(*report.findings)) {
    text += fmt::format("{}: provoked {}\n", printable(report.log), provoked);
  }
  text += fmt::format("{}: {}: {}\n", printable(report.log), totals_text(report), verdict_text(report));
  if (report.shows_cycles && report.totals.has_times) text += '\n' + cycles_text(*report.cycle_times, *report.labels);
  if (report.shows_times && has_network_times(report))
    text += '\n' + network_text(*report.network_times, report.totals);
  return text;
}

std::string json_report(const Report& report) {
  json findings = json::array();
  const Grouped grouped{report};
  for (std::size_t at = 0; at < grouped.findings.size(); ++at) {
    findings.push_back(finding_object(*grouped.findings[at], report));
    findings.back()["follows_from"] = grouped.causes[at] ? json(*grouped.causes[at]) : json(nullptr);
  }
  json provoked = json::array();
  for (const Provoked& one : report.findings->provoked()) {
    provoked.push_back({{"case", one.by->id.empty() ? json(nullptr) : json(printable(one.by->id))},
                        {"title", printable(one.by->title)},
                        {"rule", one.rule.text()},
                        {"count", one.count}});
  }
  const Totals& totals = report.totals;
  const bool has_load = report.limits.bit_rate > 0 && totals.has_times;
  const auto percent = [&](std::uint64_t tenths) {
    return has_load ? json(static_cast<double>(tenths) / 10) : json(nullptr);
  };
  const json document = {
      {"schema", 2},
      {"log", printable(report.log)},
      {"clean", report.is_clean()},
      {"frames", totals.frames},
      {"nodes", totals.nodes},
      {"duration_us", totals.has_times ? json(totals.duration_us) : json(nullptr)},
      {"mean_load_percent", percent(totals.mean_load)},
      {"max_load_percent", percent(totals.max_load)},
      {"errors", report.findings->count(Severity::error)},
      {"warnings", report.findings->count(Severity::warning)},
      {"notes", report.findings->count(Severity::note)},
      {"not_listed", report.findings->not_listed()},
      {"findings", std::move(findings)},
      {"provoked", std::move(provoked)},
      {"cycles", cycles_json(*report.cycle_times, *report.labels)},
      {"network", has_network_times(report) ? network_json(*report.network_times, totals) : json(nullptr)}};
  return json_text(document) + '\n';
}

std::string html_report(const Report& report) {
  json findings = json::array();
  const Grouped grouped{report};
  for (std::size_t at = 0; at < grouped.findings.size(); ++at) {
    if (grouped.causes[at] && !report.shows_all) continue;
    const Finding* const finding = grouped.findings[at];
    const Rule& rule = finding->subject.rule.row();
    const std::string following = following_text(grouped, at);
    findings.push_back({{"severity", to_string(rule.severity)},
                        {"subject", subject_text(*finding, report)},
                        {"meaning", rule.title},
                        {"advice", rule.explanation},
                        {"rule", rule.id},
                        {"source", rule.source},
                        {"expected", finding->expected},
                        {"seen", finding->seen},
                        {"follows", grouped.causes[at].has_value()},
                        {"has_following", !following.empty()},
                        {"following", following},
                        {"count", finding->count},
                        {"line", finding->first.line},
                        {"time", time_text(finding->first)}});
  }
  const std::vector<std::string> provoked = provoked_texts(*report.findings);
  json view = {{"page_title", "Audit of " + report.log},
               {"style", with_parts("document.css")},
               {"log", report.log},
               {"totals", totals_text(report)},
               {"verdict", verdict_text(report)},
               {"has_findings", !findings.empty()},
               {"findings", findings},
               {"has_provoked", !provoked.empty()},
               {"provoked", provoked},
               {"has_cycles", !report.cycle_times->cycles().empty()},
               {"cycles", cycles_rows(*report.cycle_times, *report.labels)},
               {"has_network", has_network_times(report)}};
  if (has_network_times(report)) view["network"] = network_view(*report.network_times, report.totals);
  return render_html(with_parts("audit.html"), view);
}

}  // namespace edsc::audit
