#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "completion/command_parts.hpp"

namespace edsc {
namespace {

constexpr const char* head = R"sh(# Completion of edsc for bash: printed by `edsc completion bash`.

_edsc_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "$1" -- "${current##*=}")
}

# Words for what is typed. readline replaces only what follows the last : or = of it.
_edsc_words() {
  local stem=""
  [[ $current == *[:=]* ]] && stem=${current%"${current##*[:=]}"}
  [[ $1 == *[:=] ]] && compopt -o nospace 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
  COMPREPLY=("${COMPREPLY[@]#"$stem"}")
}

_edsc_call() {
  _edsc_words "$("${COMP_WORDS[0]}" completion "$@" 2>/dev/null)"
}

# What completes a kind of option value or argument.
_edsc_kind() {
  case $1 in
    file | path) _edsc_files -f ;;
    folder) _edsc_files -d ;;
    node_file) _edsc_files -f ;;
    bus) _edsc_call buses ;;
    node) _edsc_call nodes ;;
    object) _edsc_call objects ${sheets[@]+"${sheets[@]}"} ;;
  esac
}

# Completes the argument at a position by the kinds of the arguments; the last one may be repeated.
_edsc_argument() {
  local kinds=("$@")
  [[ $1 == bus && -n ${EDSC_BUS-} && ${arguments[0]-$current} != *:* ]] && kinds=("${kinds[@]:1}")
  local position=${#arguments[@]}
  ((position < ${#kinds[@]})) || position=$((${#kinds[@]} - 1))
  ((position < 0)) || _edsc_kind "${kinds[position]}"
}

_edsc() {
  local current previous="" command="" word i
  local words=() arguments=() sheets=()
  COMPREPLY=()
  # bash takes : and = for words of their own.
  for ((i = 1; i <= COMP_CWORD; i++)); do
    word=${COMP_WORDS[i]}
    if ((${#words[@]} > 0)) && [[ $word == [:=] || $previous == [:=] ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
    previous=$word
  done
  current=${words[-1]}
  unset "words[-1]"
  previous=""
  for word in ${words[@]+"${words[@]}"}; do
    if [[ $previous ]]; then
      [[ $previous == --eds || $previous == --node ]] && sheets+=("${word##*=}")
      previous=""
      continue
    fi
    case "$command/$word" in
)sh";

constexpr const char* tail = R"(  esac
}

complete -F _edsc edsc
)";

/// The command and its subcommands, each before its own.
void append_all_below(std::vector<const CommandParts*>& all, const CommandParts& command) {
  all.push_back(&command);
  for (const CommandParts& sub : command.subcommands) append_all_below(all, sub);
}

/// The shell command that completes a value.
std::string completed_by(const OptionValue& value) {
  const std::vector<std::string>& words = value.words.empty() ? value.suggestions : value.words;
  if (!words.empty()) return fmt::format("_edsc_words \"{}\"", fmt::join(words, " "));
  return fmt::format("_edsc_kind {}", to_string(value.kind));
}

/// What completes an argument of the command: its subcommands, a word, or a kind for each position.
std::string arguments_of(const CommandParts& command, const CommandParts& program) {
  const bool is_help =
      !command.arguments.empty() && command.arguments.front().value.kind == OptionValueKind::command_words;
  const CommandParts& chosen_from = is_help ? program : command;
  std::vector<std::string> names;
  for (const CommandParts& sub : chosen_from.subcommands) names.push_back(sub.name);
  const std::string choice = fmt::format("_edsc_words \"{}\"", fmt::join(names, " "));
  if (!names.empty() && command.arguments.empty()) return choice;
  if (is_help) return choice;
  if (!names.empty()) {  // BUS before the subcommand
    return fmt::format("if [[ ${{#arguments[@]}} -gt 0 || -n ${{EDSC_BUS-}} ]]; then {}; else _edsc_kind bus; fi",
                       choice);
  }
  if (command.arguments.size() == 1 && !command.arguments.front().value.words.empty()) {
    return completed_by(command.arguments.front().value);
  }
  std::string kinds;
  for (const OptionParts& argument : command.arguments) {
    if (!argument.value.words.empty()) {  // in the middle, as of nmt
      return fmt::format("if [[ ${{#arguments[@]}} -eq {} ]]; then {}; else _edsc_argument{} text node; fi",
                         &argument - command.arguments.data(), completed_by(argument.value), kinds);
    }
    kinds += fmt::format(" {}", to_string(argument.value.kind));
  }
  return kinds.empty() ? ":" : "_edsc_argument" + kinds;
}

/// The patterns of the options that take a value, `"check/--format" | "check/-o"`.
std::string patterns_of(const CommandParts& command, const OptionParts& option) {
  std::vector<std::string> patterns;
  for (const std::string& name : option.names) {
    patterns.push_back(fmt::format("\"{}/{}\"", command.path_with(" "), name));
  }
  return fmt::format("{}", fmt::join(patterns, " | "));
}

}  // namespace

std::string bash_completion(const CommandParts& program) {
  std::vector<const CommandParts*> commands;
  append_all_below(commands, program);
  std::string out = head;
  const auto put = std::back_inserter(out);
  for (const CommandParts* command : commands) {
    for (const CommandParts& sub : command->subcommands) {
      fmt::format_to(put, "      \"{}/{}\") command=\"{}\" arguments=() ;;\n", command->path_with(" "), sub.name,
                     sub.path_with(" "));
    }
    for (const OptionParts& option : command->options) {
      if (option.value.name.empty()) continue;
      fmt::format_to(put, "      {}) previous=$word ;;\n", patterns_of(*command, option));
    }
  }
  out += R"(      */--eds=* | */--node=*) sheets+=("${word##*=}") ;;
      */-*) ;;
      *) arguments+=("$word") ;;
    esac
  done
  if [[ $current == --*=* ]]; then
    previous=${current%%=*}
    current=${current#*=}
  fi
  case "$command/$previous" in
)";
  for (const CommandParts* command : commands) {
    for (const OptionParts& option : command->options) {
      if (option.value.name.empty()) continue;
      fmt::format_to(put, "    {}) {}; return ;;\n", patterns_of(*command, option), completed_by(option.value));
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
                   command->path_with(" "), fmt::join(options, " "), arguments_of(*command, program));
  }
  return out + tail;
}

}  // namespace edsc
