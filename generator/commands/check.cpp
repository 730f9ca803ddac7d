#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/load_device.hpp"
#include "diagnostics/print.hpp"
#include "rules/rule.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc check eds/*.eds                    findings as a compiler shows them; exit code 1 when there are errors
  edsc check drive.eds --format json      the same for a program
  edsc check drive.eds --strict           warnings count as errors
  edsc check --list-rules                 every rule with its meaning)";

struct Settings {
  std::vector<std::string> paths;
  std::string options_path;
  std::string format = "text";
  std::vector<std::string> silence;
  std::optional<std::uint8_t> node_id;
  bool strict = false;
  bool list_rules = false;
  ColorOption color;
};

int list_rules() {
  for (const Rule& rule : all_rules()) {
    fmt::print("{:<24} {:<8} {} ({})\n", rule.id, to_string(rule.severity), rule.meaning, rule.source);
  }
  return exit_fine;
}

int check(const Settings& settings) {
  if (settings.list_rules) return list_rules();
  if (settings.paths.empty()) {
    fmt::print(stderr, "edsc check: FILE is required\n");
    return exit_wrong_usage;
  }
  int exit_code = exit_fine;
  nlohmann::json all = {{"version", 1}, {"diagnostics", nlohmann::json::array()}, {"suppressed", nlohmann::json::array()},
                        {"errors", 0}, {"warnings", 0}};
  for (const std::string& path : settings.paths) {
    Diagnostics diagnostics;
    if (settings.strict) diagnostics.treat_warnings_as_errors();
    for (const std::string& rule : settings.silence) diagnostics.silence(rule);
    const auto loaded = load_device({path, settings.options_path, "", settings.node_id}, diagnostics);
    if (settings.format == "text") {
      print_findings(stdout, diagnostics, settings.color);
    } else {
      const nlohmann::json one = print_json(diagnostics);
      for (const char* list : {"diagnostics", "suppressed"}) {
        for (const auto& row : one[list]) all[list].push_back(row);
      }
      for (const char* count : {"errors", "warnings"}) all[count] = all[count].get<int>() + one[count].get<int>();
    }
    if (diagnostics.errors() > 0) exit_code = std::max<int>(exit_code, exit_input_has_errors);
    if (loaded->unreadable) exit_code = exit_wrong_usage;
  }
  if (settings.format == "json") fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  return exit_code;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("check", "say what is wrong with data sheets");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  command->add_option("FILE", settings->paths, "EDS or DCF files");
  command->add_option("--format", settings->format, "text or json")->check(CLI::IsMember({"text", "json"}))->capture_default_str();
  command->add_option("--options", settings->options_path, "options file (default: FILE's name with .options.json, if there)");
  add_node_id_option(*command, settings->node_id);
  command->add_option("--silence", settings->silence, "a rule that is not reported; may be given more than once")
      ->check([](const std::string& rule) {
        return find_rule(rule) != nullptr ? std::string{} : "no rule is called \"" + rule + "\" (see --list-rules)";
      });
  command->add_flag("--strict", settings->strict, "warnings count as errors");
  command->add_flag("--list-rules", settings->list_rules, "list the rules and end");
  settings->color.add_to(*command);
  command->callback([settings, &exit_code] { exit_code = check(*settings); });
}

}  // namespace edsc
