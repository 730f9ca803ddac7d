#include <fmt/format.h>

#include "commands/commands.hpp"
#include "commands/load_device.hpp"
#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc diff drive-1.0.eds drive-1.1.eds                  what changed, and whom it breaks; exit code 1 when it breaks anybody
  edsc diff drive-1.0.eds drive-1.1.eds --format json    the same for a program
  edsc diff drive.eds axis1.dcf --node-id 5              a DCF against its data sheet, both as node 5)";

struct Settings {
  std::string before;
  std::string after;
  std::string format = "text";
  std::optional<std::uint8_t> node_id;
  bool keep_going = false;
  ColorOption color;
};

/// Null when there is nothing to compare; the errors are printed.
std::unique_ptr<LoadedDevice> load(const std::string& path, const Settings& settings) {
  Diagnostics diagnostics;
  auto loaded = load_device({path, "", "", settings.node_id}, diagnostics);
  if (diagnostics.errors() == 0) return loaded;
  print_findings(stderr, diagnostics, settings.color);
  return loaded->device && settings.keep_going ? std::move(loaded) : nullptr;
}

int diff(const Settings& settings) {
  const auto before = load(settings.before, settings);
  const auto after = load(settings.after, settings);
  if (!before || !after) return exit_wrong_usage;
  const Changes changes = compare_devices(*before->device, *after->device);
  if (settings.format == "json") {
    const auto json = changes_as_json(changes);
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    fmt::print("{}", changes_as_text(changes, settings.color.on(stdout)));
  }
  return changes.breaking() > 0 ? exit_input_has_errors : exit_fine;
}

}  // namespace

void add_diff_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("diff", "what changed between two data sheets, and whom it breaks");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  command->add_option("OLD", settings->before, "EDS or DCF as it was")->required();
  command->add_option("NEW", settings->after, "EDS or DCF as it is")->required();
  command->add_option("--format", settings->format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  add_node_id_option(*command, settings->node_id);
  command->add_flag("--keep-going", settings->keep_going, "compare in spite of errors; what is wrong is left out");
  settings->color.add_to(*command);
  command->callback([settings, &exit_code] { exit_code = diff(*settings); });
}

}  // namespace edsc
