#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "accept/acceptance.hpp"
#include "accept/overlay_of.hpp"
#include "accept/report/text_report.hpp"
#include "commands/commands.hpp"
#include "load/load_device.hpp"
#include "shared/compare_dictionaries.hpp"
#include "shared/conformance_test.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc overlay from-bus socketcan:can0 5 drive.eds -o drive.overlay   what the device shows that the EDS does not
  edsc check drive.overlay                                            the EDS as it is corrected)";

struct Settings : ConformanceSettings {
  std::string output;
};

/// Writes the corrections, and checks the file that they result in.
int write_corrections(const Settings& settings, NewOverlay overlay) {
  overlay.remarks = {fmt::format("Read from node {} at {} by edsc overlay from-bus", settings.node, settings.bus)};
  overlay.base = path_from(settings.output, settings.sheet);
  write_all_files({{settings.output, overlay_text(overlay)}}, {settings.sheet, settings.options});
  print_visibly(stdout, "{}: {}\n", settings.output, counted(overlay.changes.size(), "correction"));
  Diagnostics findings;
  findings.limit_notes(Notes::none);
  const auto corrected = load_device({settings.output, settings.options, "", std::nullopt}, findings);
  if (findings.errors() > 0) print_findings(findings, settings.color);
  return findings.errors() > 0 ? exit_input_has_errors : exit_fine;
}

int overlay_from_bus(const Settings& settings) {
  const auto test = prepare_conformance_test(settings);
  if (!test) return exit_wrong_usage;
  return with_bus(settings.bus, [&](LiveBus& bus) {
    const accept::Acceptance acceptance{test->findings, test->sheet(), test->report, compare_dictionaries(bus, *test)};
    const accept::Comparison& comparison = acceptance.comparison;
    write_output(accept::comparison_text(acceptance, settings.color.on(stdout)));
    flush_output();
    if (comparison.interrupted) return exit_interrupted;
    if (!comparison.lost.empty()) return exit_device_failed;
    NewOverlay overlay = accept::overlay_of(comparison);
    if (!overlay.changes.empty()) return write_corrections(settings, std::move(overlay));
    print_visibly(stdout, "{}: the device does not show an error in this file; no overlay is written\n",
                  settings.sheet);
    return exit_fine;
  });
}

}  // namespace

void add_overlay_from_bus_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, overlay_from_bus, exit_code);
  static_cast<void>(add_conformance_arguments(command, settings));
  add_options_option(command, settings.options);
  command.add_option("--output", settings.output, "the overlay").required();
  add_timeout_option(command, settings.sdo.timeout_ms);
  settings.color.add_to(command);
}

}  // namespace edsc
