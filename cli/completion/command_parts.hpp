/// The commands and options of the program, as completions and the manual page show them.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "shared/command_line.hpp"

namespace edsc {

/// The value of an option or argument.
struct OptionValue {
  std::string name;  ///< `text|json`, `NUMBER`; empty for a flag
  OptionValueKind kind = OptionValueKind::flag;
  std::vector<std::string> words;        ///< the only values; empty: any
  std::vector<std::string> suggestions;  ///< values to offer, where there are others too

  /// Whether the words are listed in the description of an option, which then has the value WORD.
  [[nodiscard]] bool has_long_list() const { return !words.empty() && name.size() > 24; }
};

struct OptionParts {
  std::vector<std::string> names;  ///< `--output`, `-o`; of an argument its name, `FILE`
  std::string description;
  OptionValue value;
  std::string default_text;  ///< empty: not shown
  bool is_argument = false;
  bool is_required = false;
  bool repeats = false;  ///< it may be given more than once

  /// Of an argument: `FILE`, `[FILE...]`
  [[nodiscard]] std::string as_usage() const;
};

struct CommandParts {
  std::string name;               ///< empty for the program
  std::vector<std::string> path;  ///< `lss`, `inquire`; empty for the program
  std::string usage;              ///< the path with the arguments between its words: `lss BUS inquire`
  std::string group;              ///< its heading in the help
  std::string description;
  std::string example_lines;  ///< the lines after `Examples:`
  std::vector<OptionParts> options;
  std::vector<OptionParts> arguments;
  std::vector<CommandParts> subcommands;
  bool takes_options_of_parent = false;

  /// `lss inquire`
  [[nodiscard]] std::string path_with(const char* separator) const;
  /// The subcommands by their heading in the help, in order.
  [[nodiscard]] std::vector<std::pair<std::string, std::vector<const CommandParts*>>> groups() const;
};

[[nodiscard]] CommandParts parts_of(Command program);

/// Null if there is no such command.
[[nodiscard]] const CommandParts* find_command(const CommandParts& program, std::span<const std::string> path);

/// `edsc read [OPTIONS] BUS NODE [OBJECT...]`
[[nodiscard]] std::string usage_line(const CommandParts& command);
/// What `--help` prints, wrapped to 80 columns.
[[nodiscard]] std::string help_text(const CommandParts& command);
/// The names of the commands.
[[nodiscard]] std::string short_help(const CommandParts& program);
/// Commands, options and their meaning as JSON.
[[nodiscard]] std::string commands_json(const CommandParts& program);

[[nodiscard]] std::string bash_completion(const CommandParts& program);
[[nodiscard]] std::string zsh_completion(const CommandParts& program);
/// edsc(1) for man, of this version.
[[nodiscard]] std::string man_page(const CommandParts& program, const std::string& version);

}  // namespace edsc
