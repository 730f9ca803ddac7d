#include "commands/check_repair.hpp"

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "backend/cpp/headers.hpp"
#include "diagnostics/print.hpp"
#include "load/load_device.hpp"
#include "overlay/repair_plan.hpp"
#include "overlay/write_overlay.hpp"
#include "rules/check_rules.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "system/temporary_folder.hpp"
#include "system/write_files.hpp"
#include "text/counted.hpp"
#include "xdd/read_xdd.hpp"
#ifndef EDSC_OFFLINE
#include "monitor/progress_line.hpp"
#include "shared/conformance_test.hpp"
#include "shared/with_bus.hpp"
#include "simulate/simulation_program.hpp"
#endif

namespace edsc {
namespace {

/// Repairs may show faults that others have hidden.
constexpr unsigned max_rounds = 8;

struct Checked {
  Diagnostics findings;
  std::unique_ptr<LoadedDevice> loaded;
};

/// The file, then the file with the overlay after each round. The plan points into all of them.
class Rounds {
 public:
  explicit Rounds(const RepairSettings& settings) : settings_{settings} {
    add(settings.path);
    // An overlay changes the EDS that `edsc format` makes of an XDD.
    if (!last().loaded->unreadable && is_xml(*last().loaded->source)) add_overlay({});
  }

  [[nodiscard]] const Checked& last() const { return *all_.back(); }

  /// Adds remedies to the plan until none is left.
  void run(RepairPlan& plan) {
    for (unsigned round = 0; round < max_rounds && plan.add(last().findings.remedies()); ++round) {
      add_overlay(plan.overlay());
    }
  }

  /// Reads a file that replaces the last one.
  void add(const std::string& path) {
    Checked& one = *all_.emplace_back(std::make_unique<Checked>());
    one.findings.collect_remedies();
    for (const std::string& rule : settings_.silence) one.findings.silence(*find_rule(check_rules, rule));
    one.loaded = load_device({path, settings_.options_path, "", settings_.node_id}, one.findings);
  }

 private:
  void add_overlay(NewOverlay overlay) {
    overlay.base = absolute_path(settings_.path);
    const std::string path = join_path(folder_.path(), fmt::format("round{}.overlay", all_.size()));
    write_all_files({{path, overlay_text(overlay)}});
    add(path);
  }

  const RepairSettings& settings_;
  TemporaryFolder folder_{"edsc-repair-"};
  std::vector<std::unique_ptr<Checked>> all_;
};

std::string counts_text(const RepairPlan& plan) {
  std::string text;
  for (const auto& [rule, count] : plan.counts()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, rule.text());
  }
  return text;
}

#ifdef EDSC_OFFLINE
int prove(const RepairSettings& /*settings*/, const Checked& /*repaired*/) {
  fmt::print("the device was not tried: this edsc has no conformance test\n");
  return exit_fine;
}
#else
constexpr std::uint8_t simulated_node_id = 5;

/// The program of the device in simulated time. Throws SimulationError.
std::string build_device(const LoadedDevice& loaded, const std::string& folder) {
  const std::string include_folder = runtime_include_folder();
  if (include_folder.empty()) throw SimulationError{"cannot find the headers of the runtime"};
  Diagnostics ignored;
  std::vector<OutputFile> files = headers_of(*loaded.device, loaded.options, "repaired", ignored);
  files.push_back({"device.cpp",
                   "#include <repaired/device.hpp>\n"
                   "#include <canopen_sim/simulated_device.hpp>\n"
                   "#include <canopen_sim/simulated_node.hpp>\n\n"
                   "static constexpr canopen::SimulatedDevice all[] = {\n"
                   "    {\"repaired\", canopen::make_simulated_node<repaired::Device>}};\n\n"
                   "int main(int argc, char** argv) { return canopen::simulate_devices(argc, argv, all); }\n"});
  for (OutputFile& file : files) file.path = join_path(folder, file.path);
  write_all_files(files);
  ProgressLine progress;
  progress.show("compiling the device");
  return build_simulation({folder, {"device.cpp"}, include_folder}, [](std::size_t) {});
}

int conform(const RepairSettings& settings, const LoadedDevice& loaded, const std::string& program) {
  ConformanceSettings conformance;
  conformance.node = loaded.device->node_id.value_or(simulated_node_id);
  conformance.bus = fmt::format("simulated:{}@{},repaired", program, conformance.node);
  conformance.sheet = settings.output;
  conformance.options = settings.options_path;
  conformance.level = "all";
  conformance.quiet = true;
  conformance.color = settings.color;
  const auto test = prepare_conformance_test(conformance);
  if (!test) return exit_wrong_usage;
  return with_bus(conformance.bus, [&](LiveBus& bus) {
    test->report.node = conformance.node;
    run_conformance_test(bus, conformance, *test);
    return test->report.interrupted ? exit_interrupted : test->report.passed() ? exit_fine : exit_device_failed;
  });
}

/// Compiles the device, starts it and runs the conformance test.
int prove(const RepairSettings& settings, const Checked& repaired) {
  const TemporaryFolder folder{"edsc-repair-"};
  try {
    const std::string program = build_device(*repaired.loaded, folder.path());
    fmt::print("the repaired device generates and compiles; its conformance test in simulated time:\n");
    flush_output();
    return conform(settings, *repaired.loaded, program);
  } catch (const SimulationError& problem) {
    print_visibly(stdout, "the device was not tried: {}\n", problem.what());
    return exit_device_failed;
  }
}
#endif

void write_overlay(const RepairSettings& settings, const RepairPlan& plan) {
  NewOverlay overlay = plan.overlay();
  overlay.remarks = {fmt::format("Repairs of {}, written by edsc check --repair", file_name_of(settings.path))};
  overlay.base = path_from(settings.output, settings.path);
  write_all_files({{settings.output, overlay_text(overlay)}}, {settings.path, settings.options_path});
  print_visibly(stdout, "{}: {}: {}\n", settings.output, counted(overlay.changes.size(), "change"), counts_text(plan));
}

}  // namespace

int repair(const RepairSettings& settings) {
  Rounds rounds{settings};
  const Checked& given = rounds.last();
  if (given.loaded->unreadable) {
    print_findings(given.findings, settings.color);
    return exit_wrong_usage;
  }
  RepairPlan plan{*given.loaded->source};
  rounds.run(plan);
  if (plan.empty()) {
    print_visibly(stdout, "{}: no finding has a certain remedy; no overlay is written\n", settings.path);
  } else {
    write_overlay(settings, plan);
    rounds.add(settings.output);
  }
  const Checked& repaired = rounds.last();
  print_text(stdout, repaired.findings, {.colour = settings.color.on(stdout), .of_check = true});
  if (!repaired.loaded->device || repaired.findings.errors() > 0) return exit_input_has_errors;
  return plan.empty() ? exit_fine : prove(settings, repaired);
}

}  // namespace edsc
