#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "completion/command_description.hpp"

namespace edsc {
namespace {

constexpr const char* head = R"(#compdef edsc
# Completion of edsc for zsh: printed by `edsc completion zsh`.

# A file, also after ID=
_edsc_file() {
  compset -P '*='
  _files
}

)";

/// In single quotes; special characters of _arguments are escaped.
std::string quoted(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string action_of(const OptionDescription& option) {
  switch (option.value) {
    case ValueKind::none: return "";
    case ValueKind::words: return fmt::format("({})", fmt::join(option.words, " "));
    case ValueKind::folder: return "_files -/";
    case ValueKind::file: return "_edsc_file";
    case ValueKind::number: return " ";
  }
  return "";
}

/// `'*--filter[show only ...]:TEXT:_edsc_file'`, one for each of its names.
void append_option(std::string& out, const OptionDescription& option) {
  for (const std::string& name : option.names) {
    fmt::format_to(std::back_inserter(out), " \\\n    '{}{}[{}]", option.repeats ? "*" : "", name, quoted(option.text));
    if (option.value != ValueKind::none) {
      fmt::format_to(std::back_inserter(out), ":{}:{}", quoted(value_words(option)), action_of(option));
    }
    out += '\'';
  }
}

void append_argument(std::string& out, const OptionDescription& argument) {
  fmt::format_to(std::back_inserter(out), " \\\n    '{}:{}:{}'",
                 argument.repeats    ? "*"
                 : argument.required ? ""
                                     : ":",
                 quoted(argument.names.front()), action_of(argument));
}

/// `_edsc_lss_inquire`
std::string function_of(const CommandDescription& command) {
  return command.path.empty() ? "_edsc" : fmt::format("_edsc_{}", fmt::join(command.path, "_"));
}

/// The subcommands of a command, each group under its name.
void append_choices(std::string& out, const CommandDescription& command) {
  const auto put = std::back_inserter(out);
  out += "      local -a commands\n";
  for (const std::string& group : groups_of(command)) {
    out += "      commands=(\n";
    for (const CommandDescription& sub : command.commands) {
      if (sub.group == group) fmt::format_to(put, "        '{}:{}'\n", sub.path.back(), quoted(sub.text));
    }
    fmt::format_to(put, "      )\n      _describe '{}' commands && ret=0\n",
                   group == "Subcommands" ? "command" : quoted(group));
  }
}

void append_function(std::string& out, const CommandDescription& command) {
  const auto put = std::back_inserter(out);
  for (const CommandDescription& sub : command.commands) append_function(out, sub);
  const bool chooses = !command.commands.empty();
  fmt::format_to(put, "{}() {{\n", function_of(command));
  if (chooses) out += "  local state line ret=1\n";
  fmt::format_to(put, "  _arguments -S{}", chooses ? " -C" : "");
  for (const OptionDescription& option : command.options) append_option(out, option);
  if (chooses) {
    out += " \\\n    '1: :->command' \\\n    '*:: :->arguments' && ret=0\n  case $state in\n    command)\n";
    append_choices(out, command);
    out += "      ;;\n    arguments)\n      case $line[1] in\n";
    for (const CommandDescription& sub : command.commands) {
      fmt::format_to(put, "        {}) {} && ret=0 ;;\n", sub.path.back(), function_of(sub));
    }
    out += "      esac\n      ;;\n  esac\n  return ret\n";
  } else {
    for (const OptionDescription& argument : command.arguments) append_argument(out, argument);
    out += '\n';
  }
  out += "}\n\n";
}

}  // namespace

std::string zsh_completion(const CommandDescription& program) {
  std::string out = head;
  append_function(out, program);
  return out + "_edsc \"$@\"\n";
}

}  // namespace edsc
