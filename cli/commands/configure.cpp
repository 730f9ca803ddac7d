#include <fmt/format.h>

#include <canopen/nmt_master/nmt_master.hpp>
#include <utility>

#include "commands/commands.hpp"
#include "configure/configuration_report.hpp"
#include "configure/configuration_run.hpp"
#include "configure/configuration_values.hpp"
#include "eds/number.hpp"
#include "monitor/progress_line.hpp"
#include "online/error_control_watch.hpp"
#include "online/live_bus.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/node_names.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc configure socketcan:can0 5 axis1.dcf --dry-run           the differences and the steps; nothing is written
  edsc configure socketcan:can0 5 axis1.dcf                     write what differs, read it back
  edsc configure socketcan:can0 5 axis1.dcf --store --start     store the parameters, then start the node
  edsc configure socketcan:can0 5 axis1.dcf --all               write all ParameterValues
  edsc configure socketcan:can0 5 axis1.bin --concise --eds drive.eds
  edsc format drive.eds --dcf --node-id 5 -o axis1.dcf          make the DCF)";

struct Settings : NodeSettings {
  std::string path;
  bool concise = false;
  bool keep_state = false;
  bool start = false;
  bool store = false;
  bool force = false;
  bool all = false;
  bool node_id_and_bit_rate = false;
  bool dry_run = false;
  std::string format = "text";

  /// Only a concise DCF needs the EDS of the network file.
  void resolve() {
    if (concise) {
      NodeSettings::resolve();
    } else {
      node = find_node_id("NODE", written_node, network);
    }
  }
  /// The file that states the device.
  [[nodiscard]] const std::string& described_by() const { return concise ? sheet : path; }
};

Configuration read_dcf(const Settings& settings, const LoadedDevice& loaded) {
  if (!loaded.sheet.is_dcf) fail(settings.path + " is not a DCF; \"edsc format --dcf\" makes one from an EDS");
  Diagnostics diagnostics;
  Configuration configuration = configuration_of(loaded.sheet, *loaded.device, diagnostics);
  print_findings(diagnostics, ColorOption{});
  if (diagnostics.errors() > 0) throw Exit{};
  return configuration;
}

Configuration read_concise(const Settings& settings, const Device* device) {
  std::vector<std::uint8_t> bytes;
  std::string problem;
  if (!read_bytes(settings.path, bytes, problem)) fail(problem);
  auto configuration = configuration_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, device);
  if (!configuration) fail(settings.path + " is not a concise DCF: its length does not match its contents");
  return std::move(*configuration);
}

/// Ends the command if the DCF states the node-ID of another node.
void check_node_id(const Settings& settings, const LoadedDevice& loaded) {
  const auto meant = parse_unsigned(loaded.sheet.commissioning.node_id.text);
  if (!meant || *meant == settings.node) return;
  fail(fmt::format("{} is for node {}, not for node {} (--force writes anyway)", settings.described_by(), *meant,
                   settings.node),
       exit_device_failed);
}

/// Ends the command if the node does not answer, or is not the device of the DCF. A node that does not answer may be in
/// Stopped.
void check_device(LiveBus& bus, SdoAccess& node, const Settings& settings, const Device* device) {
  SdoOutcome first = node.upload(0x1000, 0);
  if (first.end == SdoEnd::no_answer && !settings.keep_state && !settings.dry_run) {
    enter_pre_operational(bus, node.node());
    first = node.upload(0x1000, 0);
  }
  if (first.end == SdoEnd::no_answer) fail(fmt::format("node {} does not answer", settings.node), exit_device_failed);
  if (settings.force) return;
  if (device != nullptr) return check_node(node, *device, settings.described_by(), "--force writes anyway");
  report_not_compared(node, "identity (a concise DCF does not state it; --eds names the EDS of the device)");
}

void print_changes(const ConfigurationRun& run) {
  for (const ConfigurationChange& change : run.changes) print_visibly(stdout, "{}\n", change_text(change));
  std::fflush(stdout);
}

void print_withheld(const ConfigurationRun& run) {
  for (const ConfigurationChange& change : run.withheld) {
    print_to_stderr("edsc: not written, the node's own node-ID or bit rate: {} (--node-id-and-bit-rate writes it)\n",
                    withheld_text(run, change));
  }
}

void print_steps(const ConfigurationRun& run) {
  for (const ConfigurationStep& step : run.steps) print_visibly(stdout, "{}\n", step_text(step));
}

/// Calls `work` with hooks that show the progress.
template <class Work>
auto with_progress(const ConfigurationRun& run, const bool& restarted, std::string_view doing, const Work& work) {
  ProgressLine progress;
  return work(ConfigurationHooks{[&](std::size_t done, std::size_t of) {
                                   if (!progress.due()) return;
                                   progress.show(fmt::format("node {}: {} of {} {}", run.node, done, of, doing));
                                 },
                                 [&] { return restarted; }});
}

/// Executes the steps, and what follows after success.
void write_values(LiveBus& bus, SdoAccess& node, const Settings& settings, const Configuration& configuration,
                  const bool& restarted, ConfigurationRun& run) {
  if (!run.steps.empty() && !settings.keep_state) enter_pre_operational(bus, node.node());
  run.result =
      with_progress(run, restarted, "done", [&](const auto& hooks) { return configure_node(node, run.steps, hooks); });
  if (run.result.done()) write_time(run, node, configuration);
  if (run.result.done() && settings.store) store_parameters(run, node, settings.sdo.timeout_ms);
  if (restarted) {
    run.problems.push_back(fmt::format(
        "node {} restarted during the configuration: values written before may be lost; configure it again", run.node));
  }
  if (run.succeeded() && settings.start) bus.send_all(canopen::nmt_frame(canopen::NmtCommand::start, node.node()));
}

void print_result(const ConfigurationRun& run, bool text) {
  for (const ConfigurationFailure& failure : run.result.failures) print_to_stderr("{}\n", failure_text(failure));
  for (const std::string& problem : run.problems) print_to_stderr("edsc: {}\n", problem);
  if (text) {
    print_visibly(stdout, "{}\n", summary_text(run));
  } else {
    fmt::print("{}\n", json_text(as_json(run)));
  }
}

int configure(LiveBus& bus, const Settings& settings, const Configuration& configuration, const Device* device,
              ConfigurationRun run) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  bool restarted = false;
  const ErrorControlWatch watch{bus, settings.node, [&](canopen::NmtState state) {
                                  restarted = restarted || state == canopen::NmtState::initialisation;
                                }};
  check_device(bus, node, settings, device);
  if (settings.all) {
    choose_all(run, configuration, settings.node_id_and_bit_rate);
  } else if (!with_progress(run, restarted, "compared", [&](const auto& hooks) {
               return choose_different(run, node, configuration, settings.node_id_and_bit_rate, hooks);
             })) {
    fail(fmt::format("node {} no longer answers; nothing written", settings.node), exit_device_failed);
  }
  const bool text = settings.format == "text";
  run.steps = plan_configuration(run.values, device);
  if (text) print_changes(run);
  print_withheld(run);
  if (!settings.dry_run) {
    write_values(bus, node, settings, configuration, restarted, run);
  } else if (text && !run.steps.empty()) {
    print_visibly(stdout, "steps:\n");
    print_steps(run);
  }
  print_result(run, text);
  return run.succeeded() ? exit_fine : exit_device_failed;
}

/// All steps, without the bus.
int print_all_steps(const Settings& settings, const Configuration& configuration, const Device* device,
                    ConfigurationRun run) {
  choose_all(run, configuration, settings.node_id_and_bit_rate);
  run.steps = plan_configuration(run.values, device);
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(as_json(run)));
  } else {
    print_steps(run);
  }
  print_withheld(run);
  return exit_fine;
}

int run_configure(const Settings& settings) {
  const bool is_described = !settings.concise || !settings.sheet.empty();
  const auto loaded = is_described ? load_live_device(settings.described_by(), settings.node) : nullptr;
  const Device* const device = device_of(loaded);
  const Configuration configuration = settings.concise ? read_concise(settings, device) : read_dcf(settings, *loaded);
  if (!settings.force && loaded) check_node_id(settings, *loaded);
  ConfigurationRun run;
  run.node = settings.node;
  run.all = settings.all;
  run.dry_run = settings.dry_run;
  run.left_out = configuration.left_out;
  if (settings.dry_run && settings.all) return print_all_steps(settings, configuration, device, std::move(run));
  return with_bus(settings.bus,
                  [&](LiveBus& bus) { return configure(bus, settings, configuration, device, std::move(run)); });
}

}  // namespace

void add_configure_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_configure, exit_code);
  add_node_arguments(command, settings);
  command.add_option("FILE", settings.path, "DCF, XDC or, with --concise, concise DCF").required();
  const Option concise = command.add_flag("--concise", settings.concise);
  command.add_option("--eds", settings.sheet, "for a concise DCF: names, and the identity to check").needs(concise);
  command.add_flag("--store", settings.store, "after success (1010h)");
  command.add_flag("--start", settings.start);
  command.add_flag("--keep-state", settings.keep_state);
  command.add_flag("--all", settings.all);
  command.add_flag("--node-id-and-bit-rate", settings.node_id_and_bit_rate);
  command.add_flag("--force", settings.force, "the device does not match");
  command.add_flag("--dry-run", settings.dry_run, "with --all: all steps, without the bus");
  add_format_option(command, settings.format);
  add_timeout_option(command, settings.sdo.timeout_ms);
}

}  // namespace edsc
