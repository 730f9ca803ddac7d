#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "completion/command_parts.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::size_t help_width = 80;
constexpr std::size_t text_column = 26;

std::size_t width_of(std::string_view text) { return count_code_points(text); }

/// Appends words from `column` on, after what is in the last line already, with line breaks before `help_width`.
void append_wrapped(std::string& out, std::string_view text, std::size_t column, std::size_t at) {
  bool is_first = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!is_first && at + 1 + width_of(word) > help_width) {
      out.append("\n").append(column, ' ');
      at = column;
    } else if (!is_first) {
      out += ' ';
      ++at;
    }
    out += word;
    at += width_of(word);
    is_first = false;
  }
  out += '\n';
}

/// A name of a list and its text.
void append_row(std::string& out, const std::string& name, const std::string& text) {
  out.append("  ").append(name);
  std::size_t at = 2 + width_of(name);
  if (at + 2 > text_column) {
    out += '\n';
    at = 0;
  }
  out.append(text_column - at, ' ');
  append_wrapped(out, text, text_column, text_column);
}

std::string capitalised(std::string text) {
  const bool is_name = text.starts_with("edsc ");
  if (!is_name && !text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + (text.ends_with('.') ? "" : ".");
}

/// `--format text|json`; long lists of words are in the description.
void append_option(std::string& out, const OptionParts& option) {
  const bool is_long = option.value.has_long_list();
  std::vector<std::string> names = option.names;
  std::ranges::reverse(names);  // the short one first
  std::string name = fmt::format("{}", fmt::join(names, ", "));
  if (!option.is_argument && !option.value.name.empty()) name += " " + (is_long ? "WORD" : option.value.name);
  if (option.is_argument && option.repeats) name += "...";
  std::string text = option.description;
  const bool names_words = is_long || (option.is_argument && !option.value.words.empty());
  if (names_words) text += fmt::format(": {}", fmt::join(option.value.words, ", "));
  if (option.repeats && !option.is_argument) text += "; may be given more than once";
  if (option.is_required && !option.is_argument) text += "; required";
  if (!option.default_text.empty()) text += " (default: " + option.default_text + ")";
  append_row(out, name, text);
}

/// An example that is too long has its comment before it.
void append_example(std::string& out, std::string_view line) {
  const std::size_t comment = line.find("  ", line.find_first_not_of(' '));
  if (width_of(line) <= help_width || comment == std::string_view::npos) {
    out.append(line).append("\n");
    return;
  }
  const std::string_view text = line.substr(line.find_first_not_of(' ', comment));
  out.append("  # ");
  append_wrapped(out, text, 4, 4);
  out.append(line.substr(0, comment)).append("\n");
}

void append_examples(std::string& out, std::string_view lines) {
  if (lines.empty()) return;
  out += "\nExamples:\n";
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    append_example(out, lines.substr(0, end));
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
}

void append_commands(std::string& out, const CommandParts& command) {
  const auto groups = command.groups();
  for (const auto& [group, commands] : groups) {
    out += fmt::format("\n{}:\n", command.path.empty() ? group : "Commands");
    for (const CommandParts* const sub : commands) append_row(out, sub->name, sub->description);
  }
}

}  // namespace

std::string usage_line(const CommandParts& command) {
  std::string text = "edsc";
  if (!command.usage.empty()) text += " " + command.usage;
  text += " [OPTIONS]";
  for (const OptionParts& argument : command.arguments) text += " " + argument.as_usage();
  if (!command.subcommands.empty()) text += " COMMAND";
  return text;
}

std::string help_text(const CommandParts& command) {
  std::string out = "Usage: ";
  append_wrapped(out, usage_line(command), 11, 7);
  out += '\n';
  append_wrapped(out, capitalised(command.description), 0, 0);
  if (!command.arguments.empty()) out += "\nArguments:\n";
  for (const OptionParts& argument : command.arguments) append_option(out, argument);
  append_commands(out, command);
  if (!command.options.empty()) out += "\nOptions:\n";
  for (const OptionParts& option : command.options) append_option(out, option);
  if (command.takes_options_of_parent) out += "\nIt also has the options of \"edsc " + command.path.front() + "\".\n";
  append_examples(out, command.example_lines);
  if (command.path.empty()) {
    out += "\n\"edsc help COMMAND\" shows the options of a command, with examples.\n";
    out += "EDSC_BUS is the default of BUS, EDSC_NETWORK that of --network.\n";
  }
  return out;
}

std::string short_help(const CommandParts& program) {
  std::string out = "Usage: edsc COMMAND ...\n\n";
  for (const auto& [group, commands] : program.groups()) {
    std::vector<std::string> names;
    for (const CommandParts* const command : commands) names.push_back(command->name);
    const std::string heading = fmt::format("{:<10} ", group + ":");
    out += heading;
    append_wrapped(out, fmt::format("{}", fmt::join(names, " ")), heading.size(), heading.size());
  }
  return out + "\n\"edsc help\" describes the commands, \"edsc help COMMAND\" its options.\n";
}

const CommandParts* find_command(const CommandParts& program, std::span<const std::string> path) {
  const CommandParts* command = &program;
  for (const std::string& word : path) {
    const auto found = std::ranges::find(command->subcommands, word, &CommandParts::name);
    if (found == command->subcommands.end()) return nullptr;
    command = &*found;
  }
  return command;
}

}  // namespace edsc
