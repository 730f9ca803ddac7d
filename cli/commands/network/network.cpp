#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "commands/commands.hpp"
#include "commands/network/timing_report.hpp"
#include "network/checks/check_network.hpp"
#include "network/network.hpp"
#include "rules/check_rules.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/findings_report.hpp"
#include "shared/output.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc network check plant.json                   findings as compiler messages; exit code 1 if there are errors
  edsc network check plant.json --format sarif    the same for a code review (SARIF 2.1.0)
  edsc network check plant.json --strict          warnings count as errors
  edsc network check plant.json --times           with the worst-case response time of each message
  edsc network simulate plant.json --for 1h       load and response times seen beside those computed
  edsc network members                            every member of a network file with its meaning
  edsc network generate plant.json -o build       DCFs, concise DCFs, C++ headers, DBC file, drawings
  edsc network generate plant.json -o build --target lely        with bus.yml for a master with Lely or ros2_canopen)"
#ifndef EDSC_OFFLINE
                                 R"(
  edsc network scan socketcan:can0 --eds eds -o plant.json       the network file of the nodes on a bus
  edsc network verify socketcan:can0 plant.json                  what differs from it
  edsc network apply socketcan:can0 plant.json --start           configure all nodes, then start them
  edsc network run socketcan:can0 plant.json                     be the nodes that are not on the bus)"
#endif
    ;

struct CheckSettings {
  std::vector<std::string> paths;
  std::string format = "text";
  std::vector<std::string> silence;
  bool strict = false;
  bool all = false;
  bool times = false;
  ColorOption color;
};

struct MembersSettings {
  std::string format = "text";
};

void add_timing(const Network& network, const CheckSettings& settings, FindingsReport& report) {
  const TimingReport timing{network};
  if (settings.format == "json") report.add_network(timing.json());
  if (settings.format != "text") return;
  for (const std::string& line : timing.summary()) print_visibly(stdout, "{}: {}\n", network.source->name(), line);
  if (!settings.times) return;
  for (const std::string& line : timing.table()) fmt::print("{}\n", line);
}

int check(const CheckSettings& settings) {
  int exit_code = exit_fine;
  FindingsReport report{settings.format, settings.color, settings.all};
  for (const std::string& path : settings.paths) {
    Diagnostics diagnostics;
    if (settings.strict) diagnostics.treat_warnings_as_errors();
    diagnostics.silence_errors();
    for (const std::string& rule : settings.silence) diagnostics.silence(*find_rule(check_rules, rule));
    const auto loaded = load_network(path, diagnostics);
    check_network(loaded->network, diagnostics);
    report.add(diagnostics);
    add_timing(loaded->network, settings, report);
    if (diagnostics.errors() > 0) exit_code = std::max<int>(exit_code, exit_input_has_errors);
    if (loaded->unreadable) exit_code = exit_wrong_usage;
  }
  report.finish();
  return exit_code;
}

void add_network_check_options(Command command, int& exit_code) {
  CheckSettings& settings = define_command(command, "", check, exit_code);
  command.add_option("FILE", settings.paths, "network files (JSON)").required();
  add_choice(command, "--format", settings.format, {"text", "json", "sarif"});
  take_rules(command.add_option("--silence", settings.silence).one_value_each(), check_rules,
             "edsc check --list-rules");
  command.add_flag("--all-findings", settings.all);
  command.add_flag("--strict", settings.strict);
  command.add_flag("--times", settings.times);
  settings.color.add_to(command);
}

std::string_view to_string(MemberForm form) {
  switch (form) {
    case MemberForm::text: return "text";
    case MemberForm::number: return "number";
    case MemberForm::flag: return "flag";
    case MemberForm::texts: return "texts";
    case MemberForm::values: return "values";
  }
  return "";
}

using Json = nlohmann::ordered_json;

/// The members of one kind of object, `owner` as in `nodes.*`.
template <class Owner, std::size_t N>
void list_members(std::string_view owner, const MemberRow<Owner> (&rows)[N], const std::string& format, Json& json) {
  for (const MemberRow<Owner>& row : rows) {
    const std::string name = fmt::format("{}{}{}", owner, owner.empty() ? "" : ".", row.name);
    if (format == "text") print_visibly(stdout, "{:<32} {:<7} {}\n", name, to_string(row.form()), row.meaning);
    Json one{{"owner", owner}, {"name", row.name}, {"form", to_string(row.form())}, {"meaning", row.meaning}};
    if (row.form() == MemberForm::number) one.update({{"minimum", row.min}, {"maximum", row.max}});
    json.push_back(std::move(one));
  }
}

int members(const MembersSettings& settings) {
  Json json = Json::array();
  list_members("", network_members, settings.format, json);
  list_members("sync", sync_members, settings.format, json);
  list_members("assume", assume_members, settings.format, json);
  list_members("nodes.*", node_members, settings.format, json);
  list_members("signals[]", signal_members, settings.format, json);
  if (settings.format == "json") fmt::print("{}\n", json_text(Json{{"schema", 2}, {"members", std::move(json)}}));
  return exit_fine;
}

void add_members_options(Command command, int& exit_code) {
  MembersSettings& settings = define_command(command, "", members, exit_code);
  add_choice(command, "--format", settings.format, {"text", "json"});
}

struct ActionRow {
  const char* name;
  const char* description;
  AddOptions* add_options;
};

constexpr ActionRow actions[] = {
    {"check", "check the nodes, CAN-IDs, PDO links, SYNC and error control of a network", add_network_check_options},
    {"generate", "write the DCFs of the nodes, and C++, a DBC file and drawings of the network",
     add_network_generate_options},
    {"simulate", "run the generated devices of a network on a simulated bus: load, response times and faults",
     add_network_simulate_options},
    {"members", "list the members of a network file", add_members_options},
#ifndef EDSC_OFFLINE
    {"scan", "write a network file of the nodes on a bus", add_network_scan_options},
    {"verify", "compare the nodes on a bus with a network file", add_network_verify_options},
    {"apply", "configure the nodes on a bus as a network file states", add_network_apply_options},
    {"run", "run the nodes of a network that are not on the bus, without a compiler", add_network_run_options},
#endif
};

}  // namespace

void add_network_options(Command command, int& exit_code) {
  command.footer(examples);
  for (const ActionRow& row : actions) {
    row.add_options(command.add_subcommand(row.name, row.description), exit_code);
  }
}

}  // namespace edsc
