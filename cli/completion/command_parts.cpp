#include "completion/command_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace edsc {
namespace {

std::string with_commas_as(std::string_view separator, std::string_view words) {
  std::string text;
  for (const char c : words) c == ',' ? text += separator : text += c;
  return text;
}

}  // namespace

CommandList subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); });
}

std::vector<std::pair<std::string, CommandList>> groups_of(const CLI::App& command) {
  std::vector<std::pair<std::string, CommandList>> groups;
  for (const CLI::App* sub : subcommands_of(command)) {
    auto group = std::ranges::find(groups, sub->get_group(), &std::pair<std::string, CommandList>::first);
    if (group == groups.end()) group = groups.insert(group, {sub->get_group(), {}});
    group->second.push_back(sub);
  }
  return groups;
}

std::string path_of(const CLI::App& command, std::string_view separator) {
  if (command.get_parent() == nullptr) return "";
  const std::string parent = path_of(*command.get_parent(), separator);
  return parent.empty() ? command.get_name() : fmt::format("{}{}{}", parent, separator, command.get_name());
}

std::string examples_of(const CLI::App& command) {
  constexpr std::string_view heading = "Examples:\n";
  const std::string footer = command.get_footer();
  return footer.starts_with(heading) ? footer.substr(heading.size()) : footer;
}

OptionList options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* one) { return !one->get_positional(); });
}

OptionList arguments_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* one) { return one->get_positional(); });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true, false)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

bool repeats(const CLI::Option& option) { return option.get_items_expected_max() > 1; }

/// CLI11 appends the values that a check accepts to the type: `TEXT:{text,json}`, `UINT:INT in [1 - 127]`, `TEXT:DIR`.
OptionValue value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return {};
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open != std::string::npos && close != std::string::npos) {
    const std::string words = type.substr(open + 1, close - open - 1), list = with_commas_as(" ", words);
    return {with_commas_as("|", words), "_edsc_words \"" + list + "\"", "(" + list + ")", true};
  }
  const auto is_number = [&](std::string_view name) { return type.starts_with(name); };
  if (type.find("DIR") != std::string::npos) return {"DIR", "_edsc_files -d", "_files -/"};
  if (is_number("UINT") || is_number("INT") || is_number("FLOAT")) return {"NUMBER", ":", " "};
  return {"TEXT", "_edsc_files -f", "_edsc_file"};
}

}  // namespace edsc
