#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "completion/command_parts.hpp"

namespace edsc {
namespace {

constexpr const char* head = R"(# Completion of edsc for bash: printed by `edsc completion bash`.

_edsc_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "$current")
}

_edsc_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}

_edsc() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command="" word i
  COMPREPLY=()
  # bash takes the = of --option=value for a word.
  if [[ $current == "=" ]]; then
    current=""
  elif [[ $previous == "=" ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    case "$command/$word" in
)";

constexpr const char* tail = R"(  esac
}

complete -F _edsc edsc
)";

/// The command and its subcommands, each before its own.
void append_all_below(std::vector<const CommandParts*>& all, const CommandParts& command) {
  all.push_back(&command);
  for (const CommandParts& sub : command.subcommands) append_all_below(all, sub);
}

/// `_edsc_words "..."` after the command, or what completes its first argument.
std::string first_word(const CommandParts& command) {
  if (command.subcommands.empty()) return command.arguments.empty() ? ":" : command.arguments.front().value.bash;
  std::vector<std::string> names;
  for (const CommandParts& sub : command.subcommands) names.push_back(sub.name);
  return fmt::format("_edsc_words \"{}\"", fmt::join(names, " "));
}

}  // namespace

std::string bash_completion(const CommandParts& program) {
  std::vector<const CommandParts*> commands;
  append_all_below(commands, program);
  std::string out = head;
  const auto put = std::back_inserter(out);
  for (const CommandParts* command : commands) {
    for (const CommandParts& sub : command->subcommands) {
      fmt::format_to(put, "      \"{}/{}\") command=\"{}\" ;;\n", command->path_with(" "), sub.name,
                     sub.path_with(" "));
    }
  }
  out += "    esac\n  done\n  case \"$command/$previous\" in\n";
  for (const CommandParts* command : commands) {
    for (const OptionParts& option : command->options) {
      if (option.value.name.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) {
        patterns.push_back(fmt::format("\"{}/{}\"", command->path_with(" "), name));
      }
      fmt::format_to(put, "    {}) {}; return ;;\n", fmt::join(patterns, " | "), option.value.bash);
    }
  }
  out += "  esac\n  case \"$command\" in\n";
  for (const CommandParts* command : commands) {
    std::vector<std::string> options;
    for (const OptionParts& option : command->options) {
      options.insert(options.end(), option.names.begin(), option.names.end());
    }
    fmt::format_to(put,
                   "    \"{}\")\n      if [[ $current == -* ]]; then\n        _edsc_words \"{}\"\n      else\n        "
                   "{}\n      fi\n      ;;\n",
                   command->path_with(" "), fmt::join(options, " "), first_word(*command));
  }
  return out + tail;
}

}  // namespace edsc
