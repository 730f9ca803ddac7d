#include "completion/command_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

namespace edsc {
namespace {

std::string with_commas_as(std::string_view separator, std::string_view words) {
  std::string text;
  for (const char c : words) c == ',' ? text += separator : text += c;
  return text;
}

std::string examples_of(const CLI::App& command) {
  constexpr std::string_view heading = "Examples:\n";
  const std::string footer = command.get_footer();
  return footer.starts_with(heading) ? footer.substr(heading.size()) : footer;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true, false)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

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

CommandParts parts_below(const CLI::App& command, std::vector<std::string> path) {
  CommandParts parts;
  parts.name = path.empty() ? std::string{} : path.back();
  parts.group = command.get_group();
  parts.description = command.get_description();
  parts.example_lines = examples_of(command);
  for (const CLI::Option* option : command.get_options()) {
    OptionParts one{names_of(*option),        option->get_description(), value_of(*option),
                    option->get_positional(), option->get_required(),    option->get_items_expected_max() > 1};
    (one.is_argument ? parts.arguments : parts.options).push_back(std::move(one));
  }
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); })) {
    path.push_back(sub->get_name());
    parts.subcommands.push_back(parts_below(*sub, path));
    path.pop_back();
  }
  parts.path = std::move(path);
  return parts;
}

}  // namespace

std::string CommandParts::path_with(const char* separator) const {
  return fmt::format("{}", fmt::join(path, separator));
}

std::vector<std::pair<std::string, std::vector<const CommandParts*>>> CommandParts::groups() const {
  std::vector<std::pair<std::string, std::vector<const CommandParts*>>> found;
  for (const CommandParts& sub : subcommands) {
    auto row = std::ranges::find(found, sub.group, [](const auto& one) { return one.first; });
    if (row == found.end()) row = found.insert(row, {sub.group, {}});
    row->second.push_back(&sub);
  }
  return found;
}

CommandParts parts_of(Command program) { return parts_below(program.cli11(), {}); }

}  // namespace edsc
