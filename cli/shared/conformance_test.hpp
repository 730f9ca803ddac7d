/// The conformance test of one node as a command runs it: its options, its input and its output on the terminal.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "conform/deviations.hpp"
#include "conform/run_cases.hpp"
#include "conform/verdict.hpp"
#include "diagnostics/diagnostics.hpp"
#include "load/load_device.hpp"
#include "online/live_bus.hpp"
#include "shared/common_options.hpp"
#include "shared/live_options.hpp"

namespace edsc {

struct ConformanceSettings : NodeSettings {
  std::string options;
  std::string level = "read";
  bool store = false, application = false, outputs = false;
  bool force = false;
  std::vector<std::string> only;
  std::vector<std::string> stimuli;
  std::string deviations, log;
  std::string title, operator_name, place;
  bool quiet = false;
  std::uint32_t seed = 1;
  ColorOption color;

  /// The EDS of the network file comes with its options file.
  void resolve();
};

/// `BUS NODE FILE` and `--network`.
std::vector<Option> add_conformance_arguments(Command command, ConformanceSettings& settings);
/// What the test may do, which cases run, and what a report says about it. Other options of the command follow.
void add_conformance_options(Command command, ConformanceSettings& settings);
/// `--log`, `--title`, `--operator`, `--place`, `--seed`, `--quiet`, `--timeout` and `--color`.
void add_report_options(Command command, ConformanceSettings& settings);

/// The file of declared deviations, to which their positions point.
struct DeclaredDeviations {
  std::unique_ptr<SourceFile> source;
  std::vector<conform::Deviation> all;
};

/// A run that can begin, and its report without results.
struct ConformanceTest {
  std::unique_ptr<LoadedDevice> loaded;
  Diagnostics findings;  ///< of `edsc check`
  DeclaredDeviations deviations;
  conform::RunSettings run;
  conform::RunReport report;

  [[nodiscard]] const Device& sheet() const { return *loaded->device; }
};

/// Null if a file cannot be read or the deviations have an error; the reason is printed.
[[nodiscard]] std::unique_ptr<ConformanceTest> prepare_conformance_test(const ConformanceSettings& settings);

/// Runs the cases and prints their results as they complete.
void run_conformance_test(LiveBus& bus, const ConformanceSettings& settings, ConformanceTest& test);

}  // namespace edsc
