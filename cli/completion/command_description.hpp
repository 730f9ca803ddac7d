/// The commands of the program as data, derived from the command line parser, for completions and the manual page.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace edsc {

/// The kind of value of an option or argument.
enum class ValueKind : std::uint8_t { none, words, folder, file, number };

struct OptionDescription {
  std::vector<std::string> names;  ///< `--format`, `-o`; for an argument its name, `FILE`
  std::string text;
  ValueKind value = ValueKind::none;
  std::vector<std::string> words;  ///< of ValueKind::words
  bool required = false;
  bool repeats = false;  ///< may be given more than once
};

struct CommandDescription {
  std::vector<std::string> path;  ///< `lss`, `inquire`; empty for the program
  std::string group;              ///< heading in the help
  std::string text;
  std::string examples;  ///< lines after `Examples:`
  std::vector<OptionDescription> options;
  std::vector<OptionDescription> arguments;
  std::vector<CommandDescription> commands;
};

/// The groups of the subcommands of a command, in order.
[[nodiscard]] std::vector<std::string> groups_of(const CommandDescription& command);

[[nodiscard]] CommandDescription describe_commands(const CLI::App& program);

/// `text|json`, `NUMBER`, `FILE`
[[nodiscard]] std::string value_words(const OptionDescription& option);

[[nodiscard]] std::string bash_completion(const CommandDescription& program);
[[nodiscard]] std::string zsh_completion(const CommandDescription& program);
/// edsc(1) for man, of this version.
[[nodiscard]] std::string man_page(const CommandDescription& program, const std::string& version);

}  // namespace edsc
