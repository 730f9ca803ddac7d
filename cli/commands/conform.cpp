#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>

#include "commands/commands.hpp"
#include "conform/deviations.hpp"
#include "conform/report/candump_log.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/sha256.hpp"
#include "conform/report/text_report.hpp"
#include "conform/run_cases.hpp"
#include "load/load_device.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "online/simulated_port.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
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

constexpr const char* examples = R"(Examples:
  edsc conform socketcan:can0 5 drive.eds                          reads, and requests that a device must reject
  edsc conform socketcan:can0 5 drive.eds --level communication    also writes 1000h to 1FFFh, then restores
  edsc conform socketcan:can0 5 drive.eds --level all --html report.html
  edsc conform socketcan:can0 5 drive.eds --only 3.* --only 2.5    some cases
  edsc conform socketcan:can0 5 drive.eds --stimulus 5.4="ssh bench pull-sensor-plug"
  edsc conform --list                                              all cases, with the clause)";

struct Settings : NodeSettings {
  std::string sheet;
  std::string options;
  std::string level = "read";
  bool store = false, application = false, outputs = false;
  std::vector<std::string> only;
  std::vector<std::string> stimuli;
  std::string deviations, html, junit, json, log;
  std::string title, operator_name, place;
  bool list = false;
  bool quiet = false;
  std::uint32_t seed = 1;
  ColorOption color;
  std::vector<Option> required;  ///< unless `list`
};

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

  void begin_case(std::string_view id) override { case_ = id; }
  bool set(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) override { return run("change"); }
  bool emergency(std::uint16_t, std::uint8_t) override { return run("error"); }
  bool emergency_over(std::uint8_t) override { return run("error_over"); }
  bool power_cycle() override { return run("power_cycle"); }

 private:
  /// The command gets the requested stimulus in EDSC_STIMULUS.
  bool run(const char* what) {
    const auto found = commands_.find(case_);
    if (found == commands_.end()) return false;
    return run_command_line(found->second, "EDSC_STIMULUS", what);
  }

  std::map<std::string, std::string, std::less<>> commands_;
  std::string case_;
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

Permission permissions_of(const Settings& settings, Level level) {
  Permission all = Permission::none;
  if (settings.store || level >= Level::all) all = all | Permission::store;
  if (settings.application || level >= Level::all) all = all | Permission::application;
  if (settings.outputs || level >= Level::all) all = all | Permission::outputs;
  return all;
}

void list_cases() {
  for (const conform::AreaRow& area : conform::areas()) {
    fmt::print("{} {}\n", area.id, area.title);
    for (const CaseRow* row : conform::cases_of(area)) {
      std::string needs = fmt::format("--level {}", row_of(row->level).name);
      for (const conform::PermissionRow& option : conform::permission_options) {
        if (includes(row->needs, option.permission)) needs += fmt::format(" {}", option.option);
      }
      fmt::print("  {:<6} {} ({}; {})\n", row->id, row->title, row->clause, needs);
    }
  }
}

/// The device of the EDS and its findings. Null if a file cannot be read, with the reason printed.
std::unique_ptr<LoadedDevice> load_sheet(const Settings& settings, conform::SheetFindings& findings) {
  Diagnostics diagnostics;
  diagnostics.drop_notes();
  LoadSettings load;
  load.path = settings.sheet;
  load.options_path = settings.options;
  load.node_id = settings.node;
  auto loaded = load_device(load, diagnostics);
  findings = conform::sheet_findings(diagnostics);
  if (loaded->device) return loaded;
  print_findings(stderr, diagnostics, settings.color);
  return nullptr;
}

/// SHA-256 of the file; empty if it cannot be read again, such as standard input.
std::string hash_of_file(const std::string& path) {
  std::vector<std::uint8_t> bytes;
  std::string problem;
  if (!read_bytes(path, bytes, problem)) return {};
  return conform::sha256({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The file of declared deviations, to which their positions point.
struct DeclaredDeviations {
  std::unique_ptr<SourceFile> source;
  std::vector<conform::Deviation> all;
};

/// Nothing if the file has an error, which is printed.
std::optional<DeclaredDeviations> load_deviations(const Settings& settings) {
  DeclaredDeviations declared;
  if (settings.deviations.empty()) return declared;
  std::string problem;
  declared.source = read_source_file(settings.deviations, problem);
  if (!declared.source) fail(problem);
  Diagnostics diagnostics;
  declared.all = conform::read_deviations(*declared.source, diagnostics);
  print_findings(stderr, diagnostics, settings.color);
  if (diagnostics.errors() > 0) return std::nullopt;
  return declared;
}

/// A report in a file, and the option that names it.
struct ReportFile {
  std::string Settings::*path;
  std::string (*make)(const RunReport& run, const Device& sheet);
};

constexpr ReportFile report_files[] = {
    {&Settings::html, conform::html_report},
    {&Settings::junit, conform::junit_report},
    {&Settings::json, conform::json_report},
    {&Settings::log, [](const RunReport& run, const Device&) { return conform::candump_log(run); }},
};

/// Ends the command if one of them cannot be written.
void write_reports(const Settings& settings, const RunReport& report, const Device& sheet) {
  std::vector<OutputFile> files;
  for (const ReportFile& row : report_files) {
    if (!(settings.*row.path).empty()) files.push_back({settings.*row.path, row.make(report, sheet)});
  }
  write_all_files(files, {settings.sheet, settings.deviations});
}

/// Runs the cases and prints their results as they complete.
void run_and_print(LiveBus& bus, const Settings& settings, const LoadedDevice& loaded, conform::RunSettings& run,
                   const DeclaredDeviations& deviations, RunReport& report) {
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
  const conform::TextReport text{report, *loaded.device, settings.color.on(stdout)};
  ProgressLine progress;
  run.began = [&](const CaseRow& row, std::size_t done, std::size_t of) {
    if (done == 0 && !settings.quiet) write_output(text.head() + (run.dut.simulated ? "" : text.application_objects()));
    if (progress.due()) progress.show(fmt::format("case {} of {}: {} {}", done + 1, of, row.id, row.title));
  };
  run.ended = [&](CaseResult& result) {
    conform::apply_deviations(deviations.all, result);
    const bool shown = !settings.quiet || result.verdict == Verdict::failed;
    if (!shown) return;
    progress.hide();
    write_output(text.of(result));
    flush_output();
  };
  conform::run_cases(bus, *loaded.device, *stimuli, run, report);
  conform::find_unused_deviations(deviations.all, report);
  progress.hide();
  write_output(text.summary());
}

int run_conform(const Settings& settings) {
  if (settings.list) {
    list_cases();
    return exit_fine;
  }
  for (const Option& option : settings.required) {
    if (!option.is_given()) throw_required(option.name());
  }
  conform::SheetFindings findings;
  const auto loaded = load_sheet(settings, findings);
  const auto deviations = load_deviations(settings);
  if (!loaded || !deviations) return exit_wrong_usage;
  conform::RunSettings run;
  run.dut.node = canopen::NodeId{settings.node};
  run.dut.sdo = settings.sdo;
  run.dut.level = std::ranges::find(conform::levels, settings.level, &conform::LevelRow::name)->level;
  run.dut.permissions = permissions_of(settings, run.dut.level);
  run.dut.seed = settings.seed;
  run.dut.findings = std::move(findings);
  run.only = settings.only;
  RunReport report;
  report.bus = settings.bus;
  report.sheet = settings.sheet;
  report.options = settings.options;
  report.sheet_hash = hash_of_file(settings.sheet);
  report.product = loaded->device->product_name;
  report.vendor = loaded->device->vendor_name;
  report.version = EDSC_VERSION;
  report.title = settings.title;
  report.operator_name = settings.operator_name;
  report.place = settings.place;
  report.host = host_name();
  report.started = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return with_bus(settings.bus, [&](LiveBus& bus) {
    run_and_print(bus, settings, *loaded, run, *deviations, report);
    write_reports(settings, report, *loaded->device);
    if (report.interrupted) return exit_interrupted;
    return report.passed() ? exit_fine : exit_device_failed;
  });
}

}  // namespace

void add_conform_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_conform, exit_code);
  const Option bus = add_bus_argument(command, settings.bus);
  const Option node = add_node_argument(command, settings.node);
  const Option sheet =
      command.add_option("FILE", settings.sheet, "description of the node: EDS, DCF, XDD or XDC").required();
  add_options_option(command, settings.options);
  std::vector<std::string> names;
  for (const conform::LevelRow& row : conform::levels) names.emplace_back(row.name);
  add_choice(command, "--level", settings.level, names,
             fmt::format("what the test may do to the node: {}", fmt::join(names, ", ")).c_str());
  command.add_flag("--store", settings.store,
                   "store and restore parameters (1010h, 1011h), then restore the original values");
  command.add_flag("--application", settings.application, "write objects from 2000h, then restore the original values");
  command.add_flag("--outputs", settings.outputs, "send RPDOs and SYNC: outputs may move");
  command.add_option("--only", settings.only, "cases to run: 2.5 or 3.*; may be given more than once")
      .type_name("CASE")
      .one_value_each()
      .check([](const std::string& pattern) {
        const auto rows = conform::all_cases();
        const bool names_one =
            std::ranges::any_of(rows, [&](const CaseRow* row) { return conform::matches(pattern, row->id); });
        return names_one ? std::string{} : "unknown case \"" + pattern + "\"; --list prints the cases";
      });
  command.add_option("--stimulus", settings.stimuli, "command that acts on the node in a case: 5.4=COMMAND")
      .type_name("CASE=COMMAND")
      .one_value_each()
      .check([](const std::string& text) {
        return text.find('=') != std::string::npos ? std::string{} : "\"" + text + "\" is not CASE=COMMAND";
      });
  command
      .add_option("--deviations", settings.deviations,
                  "declared deviations of the node, with their reasons: a JSON file")
      .type_name("FILE");
  command.add_option("--html", settings.html, "write the report as one HTML file").type_name("FILE");
  command.add_option("--junit", settings.junit, "write it as JUnit XML").type_name("FILE");
  command.add_option("--json", settings.json, "write it as JSON").type_name("FILE");
  command.add_option("--log", settings.log, "write the frames as a candump log").type_name("FILE");
  command.add_option("--title", settings.title, "title of the report").type_name("TEXT");
  command.add_option("--operator", settings.operator_name, "who tests, for the report").type_name("NAME");
  command.add_option("--place", settings.place, "where the test is done, for the report").type_name("TEXT");
  command.add_option("--seed", settings.seed, "seed of the randomly chosen accesses").show_default();
  command.add_flag("--quiet", settings.quiet, "print only failures and the result");
  add_timeout_option(command, settings.sdo.timeout_ms);
  settings.color.add_to(command);
  command.add_flag("--list", settings.list, "list the cases and what they need, and end");
  for (const Option& option : {bus, node, sheet}) option.required(false);
  settings.required = {bus, node, sheet};
}

}  // namespace edsc
