#include <fmt/format.h>

#include <algorithm>

#include "backend/cpp/cpp_view.hpp"
#include "backend/json/device_view.hpp"
#include "commands/commands.hpp"
#include "load/load_device.hpp"
#include "pdo/mapping_fault.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc dump drive.eds                                      the resolved device as JSON
  edsc dump drive.eds --node-id 5 | jq '.objects[].name'   formulas as numbers; the names of all objects
  edsc dump drive.eds --cpp                                with the view of the C++ templates)";

struct Settings {
  LoadSettings load;
  bool cpp = false;
  ColorOption color;
};

/// A broken PDO is marked as broken; with any other error, parts of the EDS are missing or assumed.
bool is_incomplete(const Diagnostics& diagnostics) {
  return std::ranges::any_of(diagnostics.all(), [](const Diagnostic& one) {
    return one.severity == Severity::error && !is_mapping_rule(one.rule);
  });
}

int dump(const Settings& settings) {
  Diagnostics diagnostics;
  diagnostics.limit_notes(Notes::none);
  LoadSettings load = settings.load;
  load.check = false;
  const auto loaded = load_device(load, diagnostics);
  nlohmann::ordered_json view;
  if (loaded->device) {
    view = device_view(*loaded->device, loaded->names->identifiers());
    separate_configured_values(loaded->sheet, *loaded->device, view);
    if (settings.cpp) view["cpp"] = cpp_view(loaded->named(), loaded->options, diagnostics);
  }
  print_findings(diagnostics, settings.color);
  if (loaded->unreadable) return exit_wrong_usage;
  const bool failed = !loaded->device || is_incomplete(diagnostics);
  if (!failed) fmt::print("{}\n", json_text(view));
  return failed ? exit_input_has_errors : exit_fine;
}

}  // namespace

void add_dump_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, dump, exit_code);
  command.add_option("FILE", settings.load.path, "EDS, DCF, XDD, XDC or overlay").required();
  add_node_id_option(command, settings.load.node_id);
  add_options_option(command, settings.load.options_path);
  command.add_flag("--cpp", settings.cpp);
  command.add_flag("--keep-going", settings.load.keep_going);
  settings.color.add_to(command);
}

}  // namespace edsc
