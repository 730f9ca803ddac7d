/// The commands and options of the program, as completions and the manual page show them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "shared/command_line.hpp"

namespace edsc {

/// The value of an option or argument: how the manual page names it, and what completes it in each shell.
struct OptionValue {
  std::string name;  ///< `text|json`, `NUMBER`; empty for a flag
  std::string bash;
  std::string zsh;
  bool is_choice = false;  ///< one of the words in `name`
};

struct OptionParts {
  std::vector<std::string> names;  ///< `--output`, `-o`; of an argument its name, `FILE`
  std::string description;
  OptionValue value;
  bool is_argument = false;
  bool is_required = false;
  bool repeats = false;  ///< it may be given more than once
};

struct CommandParts {
  std::string name;               ///< empty for the program
  std::vector<std::string> path;  ///< `lss`, `inquire`; empty for the program
  std::string group;              ///< its heading in the help
  std::string description;
  std::string example_lines;  ///< the lines after `Examples:`
  std::vector<OptionParts> options;
  std::vector<OptionParts> arguments;
  std::vector<CommandParts> subcommands;

  /// `lss inquire`
  [[nodiscard]] std::string path_with(const char* separator) const;
  /// The subcommands by their heading in the help, in order.
  [[nodiscard]] std::vector<std::pair<std::string, std::vector<const CommandParts*>>> groups() const;
};

[[nodiscard]] CommandParts parts_of(Command program);

[[nodiscard]] std::string bash_completion(const CommandParts& program);
[[nodiscard]] std::string zsh_completion(const CommandParts& program);
/// edsc(1) for man, of this version.
[[nodiscard]] std::string man_page(const CommandParts& program, const std::string& version);

}  // namespace edsc
