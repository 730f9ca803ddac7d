/// The vocabulary of the command line: each option has one meaning in all commands.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace edsc {

/// What the value of an option or argument is; completions follow from it.
enum class OptionValueKind : std::uint8_t {
  flag,  ///< no value
  text,
  number,
  duration,
  word,  ///< one of some words, which the command states
  file,
  folder,
  path,       ///< a file or a folder
  node_file,  ///< `5=drive.eds`
  address,    ///< `HOST:PORT`
  bus,
  node,
  object,
  rule,           ///< a rule of `edsc check` or of the command
  case_command,   ///< `5.4=COMMAND`
  command_words,  ///< the words of a command of edsc
};

/// The word for a kind in the machine-readable list of the commands.
[[nodiscard]] std::string_view to_string(OptionValueKind kind);

/// An option. Commands that have it add details to its meaning, not another meaning.
struct CommandOptionRow {
  std::string_view name;
  char short_name = 0;     ///< `o` of `-o`; 0: none
  std::string_view value;  ///< what its value is called in the help; empty for a flag
  OptionValueKind kind = OptionValueKind::flag;
  std::string_view meaning;
};

/// An argument without a name on the command line.
struct ArgumentRow {
  std::string_view name;
  OptionValueKind kind = OptionValueKind::text;
};

/// An option as previous versions spelled it. It is read for one version, with a note.
struct OldOptionRow {
  std::string_view command;  ///< `network scan`
  std::string_view name;     ///< `--sheets`
  std::string_view now;      ///< `--eds`; empty: its value is an argument
  std::string_view unit;     ///< that a number without a unit had, if this is a duration
  std::string_view value;    ///< the value that it had where none was given; empty: it needs one
};

[[nodiscard]] std::span<const CommandOptionRow> command_option_rows();
[[nodiscard]] std::span<const OldOptionRow> old_option_rows();

/// Null if no command has the option.
[[nodiscard]] const CommandOptionRow* find_command_option(std::string_view name);
/// Null if the argument has any text.
[[nodiscard]] const ArgumentRow* find_argument_row(std::string_view name);

}  // namespace edsc
