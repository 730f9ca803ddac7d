#include <fmt/format.h>

#include <string>
#include <vector>

#include "accept/acceptance.hpp"
#include "accept/report/html_report.hpp"
#include "accept/report/json_report.hpp"
#include "accept/report/junit_report.hpp"
#include "accept/report/text_report.hpp"
#include "commands/commands.hpp"
#include "conform/report/candump_log.hpp"
#include "shared/compare_dictionaries.hpp"
#include "shared/conformance_test.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc accept socketcan:can0 5 drive.eds --html report.html                        reads only
  edsc accept socketcan:can0 5 drive.eds --html report.html --level communication  also writes 1000h to 1FFFh, then restores
  edsc accept socketcan:can0 5 drive.eds --html report.html --title "Line 3, axis 2" --operator "A. Bauer" --place Hall
  edsc accept socketcan:can0 5 drive.eds --json report.json --junit report.xml --deviations drive.deviations.json)";

struct Settings : ConformanceSettings {
  std::string html, junit, json;
};

/// Ends the command if one of them cannot be written.
void write_reports(const Settings& settings, const accept::Acceptance& acceptance) {
  std::vector<OutputFile> files;
  const auto add = [&](const std::string& path, auto make) {
    if (!path.empty()) files.push_back({path, make()});
  };
  add(settings.html, [&] { return accept::html_report(acceptance); });
  add(settings.junit, [&] { return accept::junit_report(acceptance); });
  add(settings.json, [&] { return accept::json_report(acceptance); });
  add(settings.log, [&] { return conform::candump_log(acceptance.run); });
  write_all_files(files, {settings.sheet, settings.deviations});
}

int run_accept(const Settings& settings) {
  const auto test = prepare_conformance_test(settings);
  if (!test) return exit_wrong_usage;
  return with_bus(settings.bus, [&](LiveBus& bus) {
    test->report.node = settings.node;
    accept::Acceptance acceptance{test->findings, test->sheet(), test->report, compare_dictionaries(bus, *test)};
    test->report.frames = acceptance.comparison.frames;
    test->run.dut.clock = acceptance.comparison.clock;
    const bool color = settings.color.on(stdout);
    write_output(accept::comparison_text(acceptance, color));
    flush_output();
    if (acceptance.comparison.interrupted) {
      test->report.interrupted = true;
    } else {
      run_conformance_test(bus, settings, *test);
    }
    write_reports(settings, acceptance);
    write_output(accept::verdict_text(acceptance, color));
    if (test->report.interrupted) return exit_interrupted;
    return acceptance.objections().empty() ? exit_fine : exit_device_failed;
  });
}

}  // namespace

void add_accept_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_accept, exit_code);
  add_conformance_arguments(command, settings);
  command.add_option("--html", settings.html);
  command.add_option("--junit", settings.junit);
  command.add_option("--json", settings.json, "with corrections of the EDS");
  add_conformance_options(command, settings);
  add_report_options(command, settings);
}

}  // namespace edsc
