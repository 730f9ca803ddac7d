#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "monitor/progress_line.hpp"
#include "network/checks/check_network.hpp"
#include "network/network.hpp"
#include "network/simulate/simulation_source.hpp"
#include "online/interruption.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "simulate/simulation_fault.hpp"
#include "simulate/simulation_program.hpp"
#include "simulate/simulation_report.hpp"
#include "system/path.hpp"
#include "system/temporary_folder.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network simulate plant.json                                load and response times of a minute
  edsc network simulate plant.json --for 1h -o build/simulation   keep the program
  edsc network simulate plant.json --fault lost:axis1@10s         who notices a lost node
  edsc network simulate plant.json --fault errors:1/10ms          an error frame every 10 ms
  edsc network simulate plant.json --format json                  for a program)";

constexpr std::uint64_t default_duration_us = 60'000'000;

struct Settings {
  std::string path;
  std::string output;
  std::string include_folder;
  std::string format = "text";
  std::uint64_t duration_us = default_duration_us;
  std::uint32_t seed = 1;
  std::vector<std::string> faults;
  ColorOption color;
};

std::vector<SimulationFault> parse_faults(const Settings& settings, const Network& network) {
  std::vector<SimulationFault> faults;
  for (const std::string& text : settings.faults) {
    SimulationFault& fault = faults.emplace_back();
    if (const std::string problem = parse_fault(text, network, fault); !problem.empty()) {
      fail("--fault: " + problem);
    }
    if (fault.time_us > settings.duration_us) fail(fmt::format("--fault: {} is later than the end of the run", text));
  }
  return faults;
}

/// The response times hold for the errors of the simulation as well.
void assume_errors(NetworkDescription& description, const std::vector<SimulationFault>& faults) {
  for (const SimulationFault& fault : faults) {
    if (fault.kind != FaultKind::errors) continue;
    const auto interval_ms = static_cast<std::uint32_t>(fault.time_us / 1000);
    description.error_interval_ms = Written<std::uint32_t>{std::max(interval_ms, 1U), {}};
  }
}

SimulationResult run(const Settings& settings, SimulationSource source, SimulationRun run) {
  std::optional<TemporaryFolder> temporary;
  if (settings.output.empty()) temporary.emplace("edsc-simulation-");
  const std::string folder = temporary ? temporary->path() : settings.output;
  const std::string include_folder =
      settings.include_folder.empty() ? runtime_include_folder() : settings.include_folder;
  if (include_folder.empty()) fail("cannot find the headers of the runtime; --runtime names their folder");
  for (OutputFile& file : source.files) file.path = join_path(folder, file.path);
  write_all_files(source.files);
  const std::size_t sources = source.sources.size();
  ProgressLine progress;
  progress.show_at_once(fmt::format("compiling {} files", sources));
  run.program = build_simulation({folder, std::move(source.sources), include_folder}, [&](std::size_t done) {
    progress.show(fmt::format("compiling {} of {}", done, sources));
  });
  return run_simulation(run, [&](std::uint64_t time_us) {
    progress.show(fmt::format("simulating {:.0f} of {:.0f} s", static_cast<double>(time_us) / 1e6,
                              static_cast<double>(run.duration_us) / 1e6));
  });
}

int report(const Settings& settings, const SimulatedNetwork& simulated) {
  const std::vector<std::string> problems = simulation_problems(simulated);
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(simulation_json(simulated)));
  } else {
    for (const std::string& line : simulation_lines(simulated)) print_visibly(stdout, "{}\n", line);
  }
  for (const std::string& problem : problems) print_to_stderr("edsc: {}\n", problem);
  return problems.empty() ? exit_fine : exit_device_failed;
}

int simulate(const Settings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  const auto loaded = load_network(settings.path, diagnostics);
  Network& network = loaded->network;
  check_network(network, diagnostics);
  SimulationSource source;
  NetworkTiming timing;
  std::vector<SimulationFault> faults;
  if (diagnostics.errors() == 0) {
    if (!network.description.bit_rate) fail(settings.path + ": a simulation needs \"bit_rate\"");
    faults = parse_faults(settings, network);
    assume_errors(network.description, faults);
    timing = network_timing(network, cob_id_uses(network));
    source = simulation_source(network, timing, diagnostics);
  }
  print_findings(diagnostics, settings.color);
  if (loaded->unreadable) return exit_wrong_usage;
  if (diagnostics.errors() > 0) return exit_input_has_errors;
  const Interruption interruption;
  try {
    const SimulationResult result =
        run(settings, std::move(source),
            {{}, settings.duration_us, settings.seed, faults, network.nodes.size(), timing.messages.size()});
    return report(settings, {network, timing, faults, result});
  } catch (const SimulationError& problem) {
    if (Interruption::noted()) {
      print_to_stderr("edsc: interrupted\n");
      return exit_interrupted;
    }
    write_to_stderr(fmt::format("edsc: {}\n", problem.what()));
    return exit_wrong_usage;
  }
}

}  // namespace

void add_network_simulate_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, simulate, exit_code);
  command.add_option("FILE", settings.path, "network file (JSON)").required();
  command.add_duration("--for", 1, max_simulated_us, [&settings](std::uint64_t us) { settings.duration_us = us; })
      .show_default(duration_text(settings.duration_us));
  command.add_option("--fault", settings.faults, fault_forms()).one_value_each();
  command.add_option("--seed", settings.seed).range(1, std::numeric_limits<std::uint32_t>::max()).show_default();
  command.add_option("--output", settings.output, "the program (default: a temporary folder)");
  command.add_option("--runtime", settings.include_folder).existing_folder();
  add_choice(command, "--format", settings.format, {"text", "json"});
  settings.color.add_to(command);
}

}  // namespace edsc
