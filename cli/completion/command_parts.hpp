/// The parts of a command of CLI11 that completions and the manual page show.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace edsc {

using CommandList = std::vector<const CLI::App*>;
using OptionList = std::vector<const CLI::Option*>;

[[nodiscard]] CommandList subcommands_of(const CLI::App& command);

/// The subcommands by their heading in the help, in order.
[[nodiscard]] std::vector<std::pair<std::string, CommandList>> groups_of(const CLI::App& command);

/// `lss inquire`; empty for the program.
[[nodiscard]] std::string path_of(const CLI::App& command, std::string_view separator = " ");

/// The lines after `Examples:`.
[[nodiscard]] std::string examples_of(const CLI::App& command);

[[nodiscard]] OptionList options_of(const CLI::App& command);
[[nodiscard]] OptionList arguments_of(const CLI::App& command);

/// `--output`, `-o`; of an argument its name, `FILE`.
[[nodiscard]] std::vector<std::string> names_of(const CLI::Option& option);

/// Whether it may be given more than once.
[[nodiscard]] bool repeats(const CLI::Option& option);

/// The value of an option or argument: how the manual page names it, and what completes it in each shell.
struct OptionValue {
  std::string name;  ///< `text|json`, `NUMBER`; empty for a flag
  std::string bash;
  std::string zsh;
  bool is_choice = false;  ///< one of the words in `name`
};

[[nodiscard]] OptionValue value_of(const CLI::Option& option);

[[nodiscard]] std::string bash_completion(const CLI::App& program);
[[nodiscard]] std::string zsh_completion(const CLI::App& program);
/// edsc(1) for man, of this version.
[[nodiscard]] std::string man_page(const CLI::App& program, const std::string& version);

}  // namespace edsc
