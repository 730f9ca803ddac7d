#include "completion/command_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

namespace edsc {
namespace {

std::string examples_of(const CLI::App& command) {
  constexpr std::string_view heading = "Examples:\n";
  const std::string footer = command.get_footer();
  return footer.starts_with(heading) ? footer.substr(heading.size()) : footer;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {facts_of(option).value};
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

OptionValue value_of(const CLI::Option& option) {
  const OptionFacts& facts = facts_of(option);
  if (option.get_items_expected_max() == 0) return {};
  if (facts.words.empty()) return {facts.value, facts.kind, {}, facts.suggestions};
  return {fmt::format("{}", fmt::join(facts.words, "|")), OptionValueKind::word, facts.words, {}};
}

/// `before`: the usage of the parent, with its arguments.
CommandParts parts_below(const CLI::App& command, std::vector<std::string> path, const std::string& before) {
  CommandParts parts;
  parts.name = path.empty() ? std::string{} : path.back();
  parts.usage = before.empty() ? parts.name : before + " " + parts.name;
  parts.group = command.get_group();
  parts.description = command.get_description();
  parts.example_lines = examples_of(command);
  parts.takes_options_of_parent = command.get_fallthrough();
  std::string usage = parts.usage;
  for (const CLI::Option* option : command.get_options()) {
    OptionParts one{names_of(*option),
                    option->get_description(),
                    value_of(*option),
                    facts_of(*option).default_text,
                    option->get_positional(),
                    option->get_required(),
                    facts_of(*option).repeats || option->get_items_expected_max() > 1};
    if (one.is_argument) usage += " " + one.as_usage();
    (one.is_argument ? parts.arguments : parts.options).push_back(std::move(one));
  }
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); })) {
    path.push_back(sub->get_name());
    parts.subcommands.push_back(parts_below(*sub, path, usage));
    path.pop_back();
  }
  parts.path = std::move(path);
  return parts;
}

}  // namespace

std::string OptionParts::as_usage() const {
  const std::string text = names.front() + (repeats ? "..." : "");
  return is_required ? text : "[" + text + "]";
}

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

CommandParts parts_of(Command program) { return parts_below(program.cli11(), {}, ""); }

}  // namespace edsc
