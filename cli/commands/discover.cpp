#include <fmt/format.h>

#include <chrono>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "discover/survey_report.hpp"
#include "network/describe_network.hpp"
#include "online/elapsed_time.hpp"
#include "shared/arguments.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/live_options.hpp"
#include "shared/log_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "system/path.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc discover trace.log                                   nodes, SYNC and PDOs that the log shows
  edsc discover socketcan:can0 --for 30s                    the same of a bus; nothing is sent
  edsc discover trace.log --eds eds --bit-rate 500 -o plant.json   also a network file
  edsc discover trace.log --format json                     for a program)";

constexpr std::uint64_t usual_span_us = 10'000'000;

struct Settings : LogSettings {
  std::vector<std::string> sheets;
  std::string output;
  std::string format = "text";
  std::optional<unsigned> bit_rate;
  std::optional<std::uint64_t> span_us;

  [[nodiscard]] bool is_bus() const { return is_bus_address(log); }
};

/// The frames of a bus until Ctrl-C or the end of the time.
void listen_to(LiveBus& bus, const Settings& settings, discover::BusSurvey& survey) {
  using namespace std::chrono;
  constexpr milliseconds look_again{100};
  const auto end = steady_clock::now() + microseconds{settings.span_us.value_or(usual_span_us)};
  ElapsedTime elapsed{bus.now()};
  while (!Interruption::noted()) {
    const auto left = duration_cast<milliseconds>(end - steady_clock::now());
    if (left <= milliseconds{0}) return;
    const auto frame =
        bus.receive(canopen::Duration{static_cast<std::uint32_t>(std::min(left, look_again).count()) * 1000U});
    elapsed.advance(frame ? bus.received_at() : bus.now());
    if (frame) static_cast<void>(survey.add(*frame, true, elapsed.us()));
  }
}

/// The frames of a log. Returns whether all lines were frames.
bool read_frames(const Settings& settings, discover::BusSurvey& survey) {
  LogDecoder decoder{{}, NodeLabels{}, {settings.log_name(), settings.interface, LogOutput::text, false, {}}};
  std::string complaints;
  const auto print_complaints = [&] {
    write_to_stderr(complaints);
    complaints.clear();
  };
  const auto use = [&](LogLine& line) {
    if (decoder.evaluate(line, complaints) == nullptr || line.kind != LogLineKind::frame) return;
    constexpr double second_us = 1e6;
    if (const std::int64_t back_us = survey.add(line.frame, line.has_time, line.microseconds); back_us > 0) {
      complaints += fmt::format("edsc: {}:{}: the time goes back by {:.6f} s; no period is measured across this\n",
                                printable(settings.log_name()), line.number, static_cast<double>(back_us) / second_us);
    }
  };
  const auto fail_if_unreadable = read_log(settings, use, print_complaints);
  print_complaints();
  fail_if_unreadable();
  return !decoder.skipped_lines();
}

/// Returns whether the commands for a network accept the file: it has all nodes.
bool write_network_file(const Settings& settings, const discover::BusSurvey& survey, const SheetFiles& sheets) {
  DescribeSettings describe;
  describe.folder = from_native(to_native(settings.output).parent_path());
  describe.bit_rate = settings.bit_rate;
  describe.only_listened = true;
  describe.guessed = guessed_member(survey);
  const std::vector<FoundNode> nodes = survey.found_nodes();
  for (const FoundNode& node : nodes) {
    if (!survey.heartbeat_is_read(node.node_id) && node.heartbeat_ms)
      describe.remarks[node.node_id] = "heartbeat_ms is the measured period";
  }
  const DescribedNetwork network = describe_network(nodes, sheets.files, describe);
  std::vector<std::string> inputs;
  if (!settings.is_bus() && settings.log != "-") inputs.push_back(settings.log);
  for (const SheetFile& file : sheets.files) inputs.push_back(file.path);
  write_output(settings.output, network.text, inputs);
  for (const std::string& note : network.notes) print_to_stderr("edsc: {}\n", note);
  for (const std::string& note : network.errors) print_to_stderr("edsc: {}\n", note);
  if (nodes.empty()) print_to_stderr("edsc: {}: no node was found\n", settings.output);
  return network.errors.empty() && !nodes.empty();
}

int report(const Settings& settings, const discover::BusSurvey& survey, const SheetFiles& sheets) {
  const std::string source = settings.is_bus() ? settings.log : settings.log_name();
  if (survey.frames() == 0)
    fail(source + (settings.is_bus() ? ": no frame was received" : ": the log has no frames"), exit_input_has_errors);
  const bool has_nodes = settings.output.empty() || write_network_file(settings, survey, sheets);
  write_output(settings.format == "json" ? json_report(survey, source) : text_report(survey, source));
  return has_nodes ? exit_fine : exit_input_has_errors;
}

int run_discover(const Settings& settings) {
  if (settings.span_us && !settings.is_bus()) throw_requires("--for", "a bus; a log is read to its end");
  SheetFiles sheets;
  if (!settings.sheets.empty())
    sheets = read_sheet_files(expand_folders(settings.sheets, sheet_extensions, WrittenByEdsc::skipped));
  for (const std::string& problem : sheets.problems) print_to_stderr("edsc: {}\n", problem);
  if (!settings.sheets.empty() && sheets.files.empty()) fail("--eds names no EDS, DCF or XDD file");
  discover::BusSurvey survey;
  if (settings.is_bus()) {
    return with_bus(settings.log, [&](LiveBus& bus) {
      listen_to(bus, settings, survey);
      return report(settings, survey, sheets);
    });
  }
  const bool is_complete = read_frames(settings, survey);
  const int code = report(settings, survey, sheets);
  return is_complete ? code : exit_input_has_errors;
}

}  // namespace

void add_discover_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_discover, exit_code);
  settings.log.clear();
  add_log_input_options(command, settings, "; or a bus, such as socketcan:can0").required();
  command.add_duration(
      "--for", 10'000, max_duration_us, [&settings](std::uint64_t us) { settings.span_us = us; },
      "of a bus: 10s if not given");
  command.add_option("--output", settings.output, "the network file (default: none is written)");
  command
      .add_option("--eds", settings.sheets,
                  "of nodes to find; or a folder with such files, except those that edsc has written")
      .one_value_each()
      .needs("--output");
  command.add_option("--bit-rate", settings.bit_rate, "for the network file").range(10, 1000).needs("--output");
  add_format_option(command, settings.format);
}

}  // namespace edsc
