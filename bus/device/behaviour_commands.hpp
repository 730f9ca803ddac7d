/// Commands to a simulated node: lines of standard input, and the actions of rules.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/behaviour.hpp"

namespace edsc {

struct NodeCommandRow {
  std::string_view name;
  std::string_view arguments;  ///< a pattern of read_arguments(), or text for people
  std::string_view help;
  bool in_rules;  ///< the `do` of a rule may have it
};

/// The commands, with a row for each kind of generator.
[[nodiscard]] std::span<const NodeCommandRow> command_rows();

/// A table of the commands and faults.
[[nodiscard]] std::string commands_help();

/// What a line means: an action, or a command of the program that has several nodes: `script`, `help` or `quit`.
struct ParsedCommand {
  BehaviourAction action;
  std::string program_command;
  std::string argument;  ///< of `script`
  std::string problem;   ///< empty on success
};
[[nodiscard]] ParsedCommand parse_command(std::string_view line, EntryFinder& names);

/// Reads a generator: `ramp OBJ FROM TO TIME`, as words. Returns what is wrong; empty on success.
[[nodiscard]] std::string read_generator(std::span<const std::string> words, EntryFinder& names, Generator& generator);

}  // namespace edsc
