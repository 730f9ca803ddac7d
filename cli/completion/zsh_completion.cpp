#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "completion/command_parts.hpp"

namespace edsc {
namespace {

constexpr const char* head = R"sh(#compdef edsc
# Completion of edsc for zsh: printed by `edsc completion zsh`.

# A file, also after ID=
_edsc_file() {
  compset -P '*='
  _files
}

# Words that edsc prints: buses, nodes, or the objects of the EDS files on the command line.
_edsc_call() {
  local -a found
  found=(${(f)"$(edsc completion "$@" 2>/dev/null)"})
  compadd -a found
}

_edsc_objects() {
  local -a sheets
  local i
  for ((i = 2; i < CURRENT; i++)); do
    case $words[i] in
      --eds=*|--node=*) sheets+=(${words[i]##*=}) ;;
      --eds|--node) sheets+=(${words[i + 1]##*=}) ;;
    esac
  done
  _edsc_call objects $sheets
}

)sh";

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

/// What completes a value: an action of _arguments.
std::string action_of(const OptionValue& value) {
  const std::vector<std::string>& words = value.words.empty() ? value.suggestions : value.words;
  if (!words.empty()) return fmt::format("({})", quoted(fmt::format("{}", fmt::join(words, " "))));
  switch (value.kind) {
    case OptionValueKind::file:
    case OptionValueKind::path:
    case OptionValueKind::node_file: return "_edsc_file";
    case OptionValueKind::folder: return "_files -/";
    case OptionValueKind::bus: return "_edsc_call buses";
    case OptionValueKind::node: return "_edsc_call nodes";
    case OptionValueKind::object: return "_edsc_objects";
    default: return " ";
  }
}

/// `'*--filter[show only ...]:TEXT:_edsc_file'`, one for each of its names.
void append_option(std::string& out, const OptionParts& option) {
  for (const std::string& name : option.names) {
    fmt::format_to(std::back_inserter(out), " \\\n    '{}{}[{}]", option.repeats ? "*" : "", name,
                   quoted(option.description));
    if (!option.value.name.empty()) {
      fmt::format_to(std::back_inserter(out), ":{}:{}", quoted(option.value.name), action_of(option.value));
    }
    out += '\'';
  }
}

void append_argument(std::string& out, const OptionParts& argument) {
  const char* count = argument.repeats ? "*" : argument.is_required ? "" : ":";
  fmt::format_to(std::back_inserter(out), " \\\n    '{}:{}:{}'", count, quoted(argument.names.front()),
                 action_of(argument.value));
}

/// `_edsc_lss_inquire`
std::string function_of(const CommandParts& command) {
  return command.path.empty() ? "_edsc" : "_edsc_" + command.path_with("_");
}

/// The subcommands of a command, each group under its name.
void append_choices(std::string& out, const CommandParts& command) {
  const auto put = std::back_inserter(out);
  out += "      local -a commands\n";
  const auto groups = command.groups();
  for (const auto& [group, commands] : groups) {
    out += "      commands=(\n";
    for (const CommandParts* sub : commands) {
      fmt::format_to(put, "        '{}:{}'\n", sub->name, quoted(sub->description));
    }
    fmt::format_to(put, "      )\n      _describe '{}' commands && ret=0\n",
                   groups.size() == 1 ? "command" : quoted(group));
  }
}

void append_function(std::string& out, const CommandParts& command) {
  const auto put = std::back_inserter(out);
  for (const CommandParts& sub : command.subcommands) append_function(out, sub);
  const bool chooses = !command.subcommands.empty();
  fmt::format_to(put, "{}() {{\n", function_of(command));
  if (chooses) out += "  local state line ret=1\n";
  fmt::format_to(put, "  _arguments -S{}", chooses ? " -C" : "");
  for (const OptionParts& option : command.options) append_option(out, option);
  if (chooses) {
    out += " \\\n    '1: :->command' \\\n    '*:: :->arguments' && ret=0\n  case $state in\n    command)\n";
    append_choices(out, command);
    out += "      ;;\n    arguments)\n      case $line[1] in\n";
    for (const CommandParts& sub : command.subcommands) {
      fmt::format_to(put, "        {}) {} && ret=0 ;;\n", sub.name, function_of(sub));
    }
    out += "      esac\n      ;;\n  esac\n  return ret\n";
  } else {
    for (const OptionParts& argument : command.arguments) append_argument(out, argument);
    out += '\n';
  }
  out += "}\n\n";
}

}  // namespace

std::string zsh_completion(const CommandParts& program) {
  std::string out = head;
  append_function(out, program);
  return out + "_edsc \"$@\"\n";
}

}  // namespace edsc
