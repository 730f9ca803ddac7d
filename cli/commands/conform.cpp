#include <fmt/format.h>

#include <memory>

#include "commands/commands.hpp"
#include "conform/report/candump_log.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/requirements.hpp"
#include "shared/conformance_test.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"

namespace edsc {
namespace {

using conform::CaseRow;
using conform::RunReport;

constexpr const char* examples = R"(Examples:
  edsc conform socketcan:can0 5 drive.eds                          reads, and requests that a device must reject
  edsc conform socketcan:can0 5 drive.eds --level communication    also writes 1000h to 1FFFh, then restores
  edsc conform socketcan:can0 5 drive.eds --level all --html report.html
  edsc conform socketcan:can0 5 drive.eds --only 3.* --only 2.5    some cases
  edsc conform socketcan:can0 5 drive.eds --stimulus 5.4="ssh bench pull-sensor-plug"
  edsc conform --list                                              all cases, with the clause
  edsc conform --requirements                                      what the standards require, and the cases)";

struct Settings : ConformanceSettings {
  std::string html, junit, json;
  bool list = false;
  bool requirements = false;
  std::vector<Option> required;  ///< unless `list` or `requirements`
};

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

void list_requirements() {
  for (const conform::RequirementRow& row : conform::requirements()) {
    fmt::print("{}: {}\n", row.clause, row.requirement);
    if (!row.cases.empty()) fmt::print("  cases {}\n", row.cases);
    if (!row.reason.empty()) fmt::print("  not tested: {}\n", row.reason);
  }
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

int run_conform(const Settings& settings) {
  if (settings.list) {
    list_cases();
    return exit_fine;
  }
  if (settings.requirements) {
    list_requirements();
    return exit_fine;
  }
  for (const Option& option : settings.required) {
    if (!option.is_given()) throw_required(option.name());
  }
  const auto test = prepare_conformance_test(settings);
  if (!test) return exit_wrong_usage;
  return with_bus(settings.bus, [&](LiveBus& bus) {
    run_conformance_test(bus, settings, *test);
    write_reports(settings, test->report, test->sheet());
    if (test->report.interrupted) return exit_interrupted;
    return test->report.passed() ? exit_fine : exit_device_failed;
  });
}

}  // namespace

void add_conform_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_conform, exit_code);
  settings.required = add_conformance_arguments(command, settings);
  for (const Option& argument : settings.required) argument.required(false);
  add_conformance_options(command, settings);
  command.add_option("--html", settings.html);
  command.add_option("--junit", settings.junit);
  command.add_option("--json", settings.json);
  add_report_options(command, settings);
  command.add_flag("--list", settings.list);
  command.add_flag("--requirements", settings.requirements);
}

}  // namespace edsc
