#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "commands/check_repair.hpp"
#include "commands/commands.hpp"
#include "device/options/option_table.hpp"
#include "load/load_device.hpp"
#include "rules/cause_rows.hpp"
#include "rules/check_rules.hpp"
#include "rules/rule_examples.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/file_arguments.hpp"
#include "shared/findings_report.hpp"
#include "shared/left_out_text.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc check eds/*.eds                    findings as compiler messages; exit code 1 if there are errors
  edsc check drive.eds --format json      the same for a program
  edsc check eds/*.eds --format sarif     the same for a code review (SARIF 2.1.0)
  edsc check drive.eds --strict           warnings count as errors
  edsc check drive.eds --all-findings     findings that follow from others too
  edsc check bad.eds --repair -o bad.overlay   corrections of what is certain, each with its reason
  edsc check --list-rules                 every rule with its meaning
  edsc check --explain pdo-length         one rule, and where it is documented)";

struct Settings {
  std::vector<std::string> paths;
  std::string options_path;
  std::string format = "text";
  std::vector<std::string> silence;
  std::optional<std::uint8_t> node_id;
  bool strict = false;
  std::string profile;
  bool keep_going = false;
  bool all = false;
  bool list_rules = false;
  bool list_options = false;
  std::string explained_rule;
  bool repair = false;
  std::string output;
  ColorOption color;
};

/// The rules whose findings may follow from one of this rule, in the file or in the same object.
nlohmann::ordered_json consequences_of(const Rule& rule) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CauseRow& row : cause_rows()) {
    if (row.cause != RuleId{rule}) continue;
    nlohmann::ordered_json rules = nlohmann::ordered_json::array();
    for (const AnyRule one : row.consequences) rules.push_back(one.text());
    rows.push_back({{"within", row.reach == CauseReach::file ? "file" : "object"}, {"rules", std::move(rules)}});
  }
  return rows;
}

std::string consequences_text(const Rule& rule) {
  std::string text;
  for (const auto& row : consequences_of(rule)) {
    std::string rules;
    for (const auto& one : row["rules"]) rules += (rules.empty() ? "" : ", ") + one.get<std::string>();
    text += fmt::format("Findings that may follow from it, in the {}: {}\n",
                        row["within"] == "file" ? "same file" : "same object", rules);
  }
  return text;
}

nlohmann::ordered_json to_json(const Rule& rule) {
  nlohmann::ordered_json severities = {to_string(rule.severity)};
  if (rule.mildest != rule.severity) severities.push_back(to_string(rule.mildest));
  return {{"id", rule.id},
          {"severity", to_string(rule.severity)},
          {"severities", severities},
          {"meaning", rule.title},
          {"source", rule.source},
          {"consequences", consequences_of(rule)},
          {"url", url_of(rule)}};
}

void print_example(std::string_view title, const std::vector<std::string>& blocks) {
  for (const std::string& block : blocks) fmt::print("\n{}:\n\n{}", title, block);
}

int explain(const Rule& rule, const std::string& format) {
  const std::vector<RuleExample>& of_rule = examples_of(RuleId{rule});
  if (format == "text") {
    fmt::print("{}: {}\n{}\nSource: {}\n{}", rule.id, to_string(rule.severity), rule.title, rule.source,
               consequences_text(rule));
    if (const std::string url = url_of(rule); !url.empty()) fmt::print("Documentation, with examples: {}\n", url);
    for (const RuleExample& example : of_rule) {
      print_example("Wrong", example.wrong);
      print_example("Right", example.right);
    }
  } else {
    nlohmann::ordered_json json{{"schema", 2}};
    json.update(to_json(rule));
    for (const RuleExample& example : of_rule) {
      json["examples"].push_back({{"wrong", example.wrong}, {"right", example.right}});
    }
    fmt::print("{}\n", json_text(json));
  }
  return exit_fine;
}

std::string to_line(const Rule& rule) {
  return fmt::format("{:<28} {:<8} {} ({})", rule.id, to_string(rule.severity), rule.title, rule.source);
}

nlohmann::ordered_json to_json(const OptionRow& row) {
  nlohmann::ordered_json json = {
      {"name", path_of(row)}, {"group", row.group.title}, {"form", to_string(row.form)}, {"meaning", row.meaning}};
  if (!row.flat_name.empty()) json["flat_name"] = row.flat_name;
  if (!row.group.meaning.empty()) json["group_meaning"] = row.group.meaning;
  if (!row.default_value.empty()) json["default"] = nlohmann::ordered_json::parse(row.default_value);
  if (!row.default_text.empty()) json["default_text"] = row.default_text;
  if (row.form == OptionForm::number) json.update({{"minimum", row.min}, {"maximum", row.max}});
  return json;
}

std::string to_line(const OptionRow& row) {
  const std::string_view value = row.default_text.empty() ? row.default_value : row.default_text;
  return fmt::format("{:<38} {}{}", path_of(row), row.meaning,
                     value.empty() ? "" : fmt::format(" (default: {})", value));
}

/// Lists a table, a row on each line, or as JSON.
template <class Rows>
int list(const Rows& table, const char* member, const std::string& format) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : table) {
    if (format == "text") print_visibly(stdout, "{}\n", to_line(row));
    rows.push_back(to_json(row));
  }
  if (format != "text") fmt::print("{}\n", json_text(nlohmann::ordered_json{{"schema", 2}, {member, std::move(rows)}}));
  return exit_fine;
}

int check_and_repair(const Settings& settings) {
  if (settings.output.empty()) throw_requires("--repair", "--output");
  if (settings.paths.size() != 1) fail("--repair repairs one file");
  if (settings.format != "text")
    fail("--repair writes text; edsc check --format " + settings.format + " FILE.overlay checks the result");
  if (settings.strict || settings.keep_going || settings.all || !settings.profile.empty()) {
    fail(
        "--strict, --keep-going, --all-findings and --profile are for a check; check the overlay that --repair writes");
  }
  return repair({settings.paths.front(), settings.options_path, settings.output, settings.node_id, settings.silence,
                 settings.color});
}

int check(const Settings& settings) {
  if (settings.list_rules) return list(check_rules, "rules", settings.format);
  if (settings.list_options) return list(options_table, "options", settings.format);
  if (!settings.explained_rule.empty())
    return explain(find_rule(check_rules, settings.explained_rule)->row(), settings.format);
  if (settings.paths.empty()) throw_required("FILE");
  if (settings.repair) return check_and_repair(settings);
  int exit_code = exit_fine;
  FindingsReport report{settings.format, settings.color, settings.all};
  for (const std::string& path : expand_folders(settings.paths)) {
    Diagnostics diagnostics;
    if (settings.strict) diagnostics.treat_warnings_as_errors();
    diagnostics.silence_errors();
    for (const std::string& rule : settings.silence) diagnostics.silence(*find_rule(check_rules, rule));
    LoadSettings load{path, settings.options_path, "", settings.node_id};
    load.keep_going = settings.keep_going;
    load.needs_reasons = settings.strict;
    load.profile_path = settings.profile;
    const auto loaded = load_device(load, diagnostics);
    if (!loaded->unreadable) report_unused_allowances(*loaded, diagnostics);
    report.add(diagnostics);
    if (settings.keep_going && loaded->device) report.add_left_out(all_left_out(*loaded));
    if (diagnostics.errors() > 0) exit_code = std::max<int>(exit_code, exit_input_has_errors);
    if (loaded->unreadable) exit_code = exit_wrong_usage;
  }
  report.finish();
  return exit_code;
}

}  // namespace

void add_check_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, check, exit_code);
  command.add_option("FILE", settings.paths, "EDS, DCF, XDD, XDC or overlay files, or folders with such files");
  add_choice(command, "--format", settings.format, {"text", "json", "sarif"});
  add_options_option(command, settings.options_path);
  add_node_id_option(command, settings.node_id);
  command.add_option("--profile", settings.profile);
  take_rules(command.add_option("--silence", settings.silence).one_value_each(), check_rules, "--list-rules");
  command.add_flag("--keep-going", settings.keep_going);
  command.add_flag("--all-findings", settings.all);
  command.add_flag("--strict", settings.strict, "a section of an overlay needs a reason");
  command.add_flag("--repair", settings.repair);
  command.add_option("--output", settings.output, "of --repair: the overlay");
  command.add_flag("--list-rules", settings.list_rules);
  command.add_flag("--list-options", settings.list_options);
  take_rules(command.add_option("--explain", settings.explained_rule), check_rules, "--list-rules");
  settings.color.add_to(command);
}

}  // namespace edsc
