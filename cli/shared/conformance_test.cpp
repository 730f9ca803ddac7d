#include "shared/conformance_test.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <span>
#include <string_view>

#include "conform/report/sha256.hpp"
#include "conform/report/text_report.hpp"
#include "conform/sheet_findings.hpp"
#include "monitor/progress_line.hpp"
#include "online/simulated_port.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/output.hpp"
#include "system/host_name.hpp"
#include "system/run_program.hpp"

namespace edsc {
namespace {

using conform::CaseResult;
using conform::CaseRow;
using conform::Level;
using conform::Permission;
using conform::RunReport;
using conform::Verdict;

/// Tolerance for times on a real bus: half a tick of 100 Hz, and the preceding frames on the bus.
constexpr canopen::Duration live_tolerance = canopen::from_milliseconds(10);

/// User commands that act on the device, one per case.
class CommandStimuli final : public conform::Stimuli {
 public:
  explicit CommandStimuli(const std::vector<std::string>& options) {
    for (const std::string& option : options) {
      const std::size_t equals = option.find('=');
      commands_[option.substr(0, equals)] = option.substr(equals + 1);
    }
  }

  void begin_case(std::string_view id) override {
    case_ = id;
    failed_ = false;
  }
  bool set(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) override { return run("change"); }
  bool emergency(std::uint16_t, std::uint8_t) override { return run("error"); }
  bool emergency_over(std::uint8_t) override { return run("error_over"); }
  bool power_cycle() override { return run("power_cycle"); }
  [[nodiscard]] bool command_failed() const override { return failed_; }

 private:
  /// The command gets the requested stimulus in EDSC_STIMULUS.
  bool run(const char* what) {
    const auto found = commands_.find(case_);
    if (found == commands_.end()) return false;
    const bool succeeds = run_command_line(found->second, "EDSC_STIMULUS", what);
    failed_ = !succeeds;
    return succeeds;
  }

  std::map<std::string, std::string, std::less<>> commands_;
  std::string case_;
  bool failed_ = false;
};

/// A simulated device receives stimuli through its program.
class SimulatedStimuli final : public conform::Stimuli {
 public:
  explicit SimulatedStimuli(SimulatedPort& port) : port_{port} {}

  bool set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value) override {
    return port_.set(index, sub_index, value) == canopen::ok;
  }
  bool emergency(std::uint16_t code, std::uint8_t error_register) override {
    return port_.emergency(code, canopen::ErrorRegister{error_register});
  }
  bool emergency_over(std::uint8_t error_register) override {
    return port_.emergency_over(canopen::ErrorRegister{error_register});
  }
  bool power_cycle() override { return port_.power_cycle(); }

 private:
  SimulatedPort& port_;
};

/// The cases, for completions.
std::vector<std::string> case_ids(std::string_view suffix = {}) {
  std::vector<std::string> ids;
  for (const CaseRow* const row : conform::all_cases()) ids.push_back(fmt::format("{}{}", row->id, suffix));
  return ids;
}

Permission permissions_of(const ConformanceSettings& settings, Level level) {
  Permission all = Permission::none;
  if (settings.store || level >= Level::all) all = all | Permission::store;
  if (settings.application || level >= Level::all) all = all | Permission::application;
  if (settings.outputs || level >= Level::all) all = all | Permission::outputs;
  return all;
}

/// Reads the EDS and keeps its findings. Returns false if it cannot be read, with the reason printed.
bool load_sheet(const ConformanceSettings& settings, ConformanceTest& test) {
  LoadSettings load;
  load.path = settings.sheet;
  load.options_path = settings.options;
  load.node_id = settings.node;
  test.loaded = load_device(load, test.findings);
  test.run.dut.findings = conform::sheet_findings(test.findings);
  if (test.loaded->device) return true;
  print_findings(test.findings, settings.color);
  return false;
}

/// SHA-256 of the file; empty if it cannot be read again, such as standard input.
std::string hash_of_file(const std::string& path) {
  std::vector<std::uint8_t> bytes;
  std::string problem;
  if (!read_bytes(path, bytes, problem)) return {};
  return conform::sha256({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

conform::InputFile input_file(const std::string& path) { return {path, hash_of_file(path)}; }

/// Returns false if the file has an error, which is printed.
bool load_deviations(const ConformanceSettings& settings, DeclaredDeviations& declared) {
  if (settings.deviations.empty()) return true;
  std::string problem;
  declared.source = read_source_file(settings.deviations, problem);
  if (!declared.source) fail(problem);
  Diagnostics diagnostics;
  declared.all = conform::read_deviations(*declared.source, diagnostics);
  print_findings(diagnostics, settings.color);
  return diagnostics.errors() == 0;
}

}  // namespace

void ConformanceSettings::resolve() {
  const bool has_sheet = !sheet.empty();
  const NamedNode found = NodeSettings::resolve();
  if (!has_sheet && options.empty()) options = found.options;
}

std::unique_ptr<ConformanceTest> prepare_conformance_test(const ConformanceSettings& settings) {
  if (settings.sheet.empty()) throw_required("FILE or --network");
  auto test = std::make_unique<ConformanceTest>();
  const bool has_sheet = load_sheet(settings, *test);
  if (!load_deviations(settings, test->deviations) || !has_sheet) return nullptr;
  conform::RunSettings& run = test->run;
  run.dut.node = canopen::NodeId{settings.node};
  run.dut.sdo = settings.sdo;
  run.dut.level = std::ranges::find(conform::levels, settings.level, &conform::LevelRow::name)->level;
  run.dut.permissions = permissions_of(settings, run.dut.level);
  run.dut.seed = settings.seed;
  run.force = settings.force;
  run.only = settings.only;
  RunReport& report = test->report;
  report.bus = settings.bus;
  report.sheet = settings.sheet;
  report.options = settings.options;
  report.sheet_hash = hash_of_file(settings.sheet);
  if (test->loaded->options_source) report.options_file = input_file(test->loaded->options_source->name());
  if (!settings.deviations.empty()) report.deviations_file = input_file(settings.deviations);
  report.product = test->sheet().product_name;
  report.vendor = test->sheet().vendor_name;
  report.version = EDSC_VERSION;
  report.title = settings.title;
  report.operator_name = settings.operator_name;
  report.place = settings.place;
  report.host = host_name();
  report.started = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return test;
}

void run_conformance_test(LiveBus& bus, const ConformanceSettings& settings, ConformanceTest& test) {
  conform::RunSettings& run = test.run;
  RunReport& report = test.report;
  auto* const simulated = dynamic_cast<SimulatedPort*>(&bus.port());
  std::unique_ptr<conform::Stimuli> stimuli;
  run.dut.simulated = simulated != nullptr;
  if (simulated != nullptr) {
    stimuli = std::make_unique<SimulatedStimuli>(*simulated);
    report.composition = simulated->composition();
    run.dut.omitted = simulated->composition().omitted;
  } else {
    stimuli = std::make_unique<CommandStimuli>(settings.stimuli);
    run.dut.tolerance = live_tolerance;
  }
  const conform::TextReport text{report, test.sheet(), settings.color.on(stdout)};
  ProgressLine progress;
  run.began = [&](const CaseRow& row, std::size_t done, std::size_t of) {
    if (done == 0 && !settings.quiet) write_output(text.head() + (run.dut.simulated ? "" : text.application_objects()));
    if (progress.due()) progress.show(fmt::format("case {} of {}: {} {}", done + 1, of, row.id, row.title));
  };
  run.ended = [&](CaseResult& result) {
    conform::apply_deviations(test.deviations.all, result);
    const bool shown = !settings.quiet || result.verdict == Verdict::failed;
    if (!shown) return;
    progress.hide();
    write_output(text.of(result));
    flush_output();
  };
  conform::run_cases(bus, test.sheet(), *stimuli, run, report);
  conform::apply_deviations(test.deviations.all, report);
  conform::find_unused_deviations(test.deviations.all, report);
  progress.hide();
  write_output(text.summary());
}

std::vector<Option> add_conformance_arguments(Command command, ConformanceSettings& settings) {
  std::vector<Option> arguments = add_node_arguments(command, settings);
  command.add_option("FILE", settings.sheet,
                     "description of the node: EDS, DCF, XDD or XDC (default: that of the network file)");
  return arguments;
}

void add_conformance_options(Command command, ConformanceSettings& settings) {
  add_options_option(command, settings.options);
  std::vector<std::string> names;
  for (const conform::LevelRow& row : conform::levels) names.emplace_back(row.name);
  add_choice(command, "--level", settings.level, names);
  command.add_flag("--store", settings.store, "1010h and 1011h, then restore the original values");
  command.add_flag("--application", settings.application);
  command.add_flag("--outputs", settings.outputs);
  command.add_flag("--force", settings.force, "the device has another vendor-ID or product code");
  command.add_option("--only", settings.only, "a case, 2.5, or several, 3.*")
      .one_value_each()
      .check([](const std::string& pattern) {
        const auto rows = conform::all_cases();
        const bool names_one =
            std::ranges::any_of(rows, [&](const CaseRow* row) { return conform::matches(pattern, row->id); });
        return names_one ? std::string{} : "unknown case \"" + pattern + "\"; edsc conform --list prints the cases";
      })
      .suggest(case_ids());
  command.add_option("--stimulus", settings.stimuli)
      .one_value_each()
      .check([](const std::string& text) {
        return text.find('=') != std::string::npos ? std::string{} : "\"" + text + "\" is not CASE=COMMAND";
      })
      .suggest(case_ids("="));
  command.add_option("--deviations", settings.deviations);
}

void add_report_options(Command command, ConformanceSettings& settings) {
  command.add_option("--log", settings.log);
  command.add_option("--title", settings.title);
  command.add_option("--operator", settings.operator_name);
  command.add_option("--place", settings.place);
  command.add_option("--seed", settings.seed).show_default();
  command.add_flag("--quiet", settings.quiet);
  add_timeout_option(command, settings.sdo.timeout_ms);
  settings.color.add_to(command);
}

}  // namespace edsc
