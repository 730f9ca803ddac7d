#include "completion/command_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace edsc {
namespace {

/// CLI11 appends the accepted values of a check to the type: `TEXT:{text,json}`, `UINT:INT in [1 - 127]`, `TEXT:DIR`.
void take_value(const std::string& type_name, OptionDescription& option) {
  const std::size_t open = type_name.find('{');
  const std::size_t close = type_name.find('}', open);
  if (open != std::string::npos && close != std::string::npos) {
    option.value = ValueKind::words;
    for (std::size_t at = open + 1; at <= close;) {
      const std::size_t end = std::min(type_name.find(',', at), close);
      option.words.push_back(type_name.substr(at, end - at));
      at = end + 1;
    }
  } else if (type_name.find("DIR") != std::string::npos) {
    option.value = ValueKind::folder;
  } else if (type_name.starts_with("UINT") || type_name.starts_with("INT") || type_name.starts_with("FLOAT")) {
    option.value = ValueKind::number;
  } else {
    option.value = ValueKind::file;
  }
}

OptionDescription describe_option(const CLI::Option& from) {
  OptionDescription option;
  if (from.get_positional()) {
    option.names = {from.get_name(true, false)};
  } else {
    for (const std::string& name : from.get_lnames()) option.names.push_back("--" + name);
    for (const std::string& name : from.get_snames()) option.names.push_back("-" + name);
  }
  option.text = from.get_description();
  option.required = from.get_required();
  option.repeats = from.get_items_expected_max() > 1;
  if (from.get_items_expected_max() > 0) take_value(from.get_type_name(), option);
  return option;
}

CommandDescription describe(const CLI::App& app, std::vector<std::string> path) {
  CommandDescription command;
  command.group = app.get_group();
  command.text = app.get_description();
  command.examples = app.get_footer();
  constexpr std::string_view heading = "Examples:\n";
  if (command.examples.starts_with(heading)) command.examples.erase(0, heading.size());
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? command.arguments : command.options).push_back(describe_option(*option));
  }
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); })) {
    std::vector<std::string> sub_path = path;
    sub_path.push_back(sub->get_name());
    command.commands.push_back(describe(*sub, std::move(sub_path)));
  }
  command.path = std::move(path);
  return command;
}

}  // namespace

CommandDescription describe_commands(const CLI::App& program) { return describe(program, {}); }

std::vector<std::string> groups_of(const CommandDescription& command) {
  std::vector<std::string> groups;
  for (const CommandDescription& sub : command.commands) {
    if (std::ranges::find(groups, sub.group) == groups.end()) groups.push_back(sub.group);
  }
  return groups;
}

std::string value_words(const OptionDescription& option) {
  switch (option.value) {
    case ValueKind::none: return "";
    case ValueKind::words: return fmt::format("{}", fmt::join(option.words, "|"));
    case ValueKind::folder: return "DIR";
    case ValueKind::file: return "TEXT";
    case ValueKind::number: return "NUMBER";
  }
  return "";
}

}  // namespace edsc
