#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "audit/audit_report.hpp"
#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "monitor/progress_line.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/log_options.hpp"
#include "shared/node_names.hpp"
#include "shared/output.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc audit can0.log --node 5=drive.eds --node 6=axis2.dcf       exit code 1 if there are errors or warnings
  edsc audit can0.log                                             without an EDS: SDO, NMT, LSS, lost nodes, gaps
  edsc audit trip.asc --node axis1.dcf --bit-rate 500             also the load of the bus
  edsc audit can0.log --node axis1.dcf --cycles                   also cycle times and jitter
  edsc audit can0.log --network plant.json --times                measured times beside the computed bounds
  edsc audit capture.pcapng --node axis1.dcf --format html -o audit.html
  candump -L can0 | edsc audit --node axis1.dcf --silence can-id-unknown
  edsc audit frames.log --node 5=drive.eds --conform report.json  a log and a report of one conformance test
  edsc audit --list-rules                                         every rule with its meaning)";

struct Settings : LogSettings {
  audit::Limits limits;
  unsigned timeout_ms = 1000;
  std::uint32_t bit_rate_kbit = 0;
  std::string written_master;  ///< node-ID or name
  std::uint8_t nmt_master = 0;
  std::vector<std::string> silence;
  std::string conform;  ///< path of a report of edsc conform; empty: none
  std::string format = "text";
  std::string output;
  bool cycles = false;
  bool times = false;
  bool all_findings = false;
  bool list_rules = false;

  void resolve() {
    if (!written_master.empty()) nmt_master = find_node_id("--master", written_master, network);
  }
};

int list_rules(const Settings& settings) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Rule& rule : audit::audit_rules) {
    if (settings.format == "text") {
      fmt::print("{:<20} {:<8} {} ({})\n", rule.id, to_string(rule.severity), rule.title, rule.source);
    }
    rows.push_back({{"id", rule.id},
                    {"severity", to_string(rule.severity)},
                    {"meaning", rule.title},
                    {"source", rule.source},
                    {"advice", rule.explanation}});
  }
  if (settings.format != "text")
    fmt::print("{}\n", json_text(nlohmann::ordered_json{{"schema", 2}, {"rules", std::move(rows)}}));
  return exit_fine;
}

/// Ends the command if it cannot be read.
audit::Provocations read_provocations(const std::string& path) {
  std::string problem;
  const std::unique_ptr<SourceFile> file = read_source_file(path, problem);
  if (!file) fail(problem);
  auto provocations = audit::Provocations::read(file->text(), problem);
  if (!provocations) fail(path + ": " + problem, exit_input_has_errors);
  return std::move(*provocations);
}

std::string report_text(const audit::Report& report, const Settings& settings) {
  if (settings.format == "json") return json_report(report);
  if (settings.format == "html") return html_report(report);
  return text_report(report, settings.output.empty() && settings.color.on(stdout));
}

/// The bit rate of the command line, otherwise that of the network file; 0: not known.
std::uint32_t bit_rate_of(const Settings& settings, const GivenNodes& nodes) {
  if (settings.bit_rate_kbit != 0 || !nodes.network) return settings.bit_rate_kbit;
  const WrittenNumber& of_network = nodes.network->network.description.bit_rate;
  return of_network ? of_network->value : 0;
}

int audit_log(const Settings& given) {
  if (given.list_rules) return list_rules(given);
  Settings settings = given;
  settings.limits.sdo_timeout_us = std::int64_t{settings.timeout_ms} * 1000;
  const GivenNodes nodes = load_given_nodes(settings, settings.color);
  if (settings.times && !nodes.network) throw_requires("--times", "--network");
  settings.limits.bit_rate = bit_rate_of(settings, nodes) * 1000;
  LogDecoder decoder{
      nodes.known_with_masters(), nodes.labels, {settings.log_name(), settings.interface, LogOutput::text, false, {}}};
  audit::Auditor auditor{decoder.decoder(), settings.limits};
  auditor.set_nmt_master(settings.nmt_master);
  if (nodes.network) auditor.measure(nodes.network->network);
  if (!settings.conform.empty()) auditor.expect(read_provocations(settings.conform));
  for (const std::string& id : settings.silence) auditor.silence(*find_rule(audit::audit_rules, id));

  std::uint64_t frames = 0;
  std::string complaints;
  ProgressLine progress;
  const auto print_complaints = [&] {
    if (complaints.empty()) return;
    progress.hide();
    write_to_stderr(complaints);
    complaints.clear();
  };
  const auto use = [&](LogLine& line) {
    const Message* const message = decoder.evaluate(line, complaints);
    if (message == nullptr) return;
    auditor.see(line, *message);
    constexpr std::uint64_t some_frames = 4096;
    if (++frames % some_frames == 0 && progress.due()) progress.show(counted(frames, "frame"));
  };
  const auto fail_if_unreadable = read_log(settings, use, print_complaints);
  auditor.finish();
  print_complaints();
  progress.hide();
  if (frames == 0) {
    fail_if_unreadable();
    fail(settings.log_name() + ": the log has no frames", exit_input_has_errors);
  }
  const audit::Report report{.log = settings.log_name(),
                             .totals = auditor.totals(),
                             .limits = settings.limits,
                             .decoder = &decoder.decoder(),
                             .labels = &nodes.labels,
                             .findings = &auditor.findings(),
                             .incidents = &auditor.incidents(),
                             .cycle_times = &auditor.cycle_times(),
                             .network_times = auditor.network_times(),
                             .shows_cycles = settings.cycles,
                             .shows_times = settings.times,
                             .shows_all = settings.all_findings};
  write_output(settings.output, report_text(report, settings),
               settings.log == "-" ? std::vector<std::string>{} : std::vector{settings.log});
  fail_if_unreadable();
  return report.is_clean() && !decoder.skipped_lines() ? exit_fine : exit_input_has_errors;
}

}  // namespace

void add_audit_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, audit_log, exit_code);
  add_log_options(command, settings);
  command.add_option("--tolerance", settings.limits.tolerance).range(0, 1000).show_default();
  command.add_milliseconds("--timeout", settings.timeout_ms, 1, 3'600'000, "to an SDO request");
  command.add_option("--master", settings.written_master);
  command
      .add_option("--bit-rate", settings.bit_rate_kbit, "to compute the bus load (default: that of the network file)")
      .range(1, 1000);
  command.add_option("--max-load", settings.limits.max_load).range(1, 100).show_default();
  take_rules(command.add_option("--silence", settings.silence).one_value_each(), audit::audit_rules, "--list-rules");
  command.add_option("--conform", settings.conform);
  add_choice(command, "--format", settings.format, {"text", "json", "html"});
  command.add_option("--output", settings.output, "default: standard output");
  command.add_flag("--cycles", settings.cycles, "JSON and HTML always have them");
  command.add_flag("--times", settings.times,
                   "of the network file, beside the measured times; JSON and HTML always have them");
  command.add_flag("--all-findings", settings.all_findings, "JSON always has them");
  command.add_flag("--list-rules", settings.list_rules);
}

}  // namespace edsc
