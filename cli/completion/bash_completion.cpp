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
CommandList all_below(const CLI::App& command) {
  CommandList all{&command};
  for (const CLI::App* sub : subcommands_of(command)) {
    const CommandList below = all_below(*sub);
    all.insert(all.end(), below.begin(), below.end());
  }
  return all;
}

std::string names_of_all(const CommandList& commands) {
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  return fmt::format("{}", fmt::join(names, " "));
}

/// `_edsc_words "..."` after the command, or what completes its first argument.
std::string first_word(const CLI::App& command) {
  const CommandList subcommands = subcommands_of(command);
  if (!subcommands.empty()) return fmt::format("_edsc_words \"{}\"", names_of_all(subcommands));
  const OptionList arguments = arguments_of(command);
  return arguments.empty() ? ":" : value_of(*arguments.front()).bash;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  const CommandList commands = all_below(program);
  std::string out = head;
  const auto put = std::back_inserter(out);
  for (const CLI::App* command : commands) {
    for (const CLI::App* sub : subcommands_of(*command)) {
      fmt::format_to(put, "      \"{}/{}\") command=\"{}\" ;;\n", path_of(*command), sub->get_name(), path_of(*sub));
    }
  }
  out += "    esac\n  done\n  case \"$command/$previous\" in\n";
  for (const CLI::App* command : commands) {
    for (const CLI::Option* option : options_of(*command)) {
      const OptionValue value = value_of(*option);
      if (value.name.empty()) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : names_of(*option)) {
        patterns.push_back(fmt::format("\"{}/{}\"", path_of(*command), name));
      }
      fmt::format_to(put, "    {}) {}; return ;;\n", fmt::join(patterns, " | "), value.bash);
    }
  }
  out += "  esac\n  case \"$command\" in\n";
  for (const CLI::App* command : commands) {
    std::vector<std::string> options;
    for (const CLI::Option* option : options_of(*command)) {
      for (std::string& name : names_of(*option)) options.push_back(std::move(name));
    }
    fmt::format_to(put,
                   "    \"{}\")\n      if [[ $current == -* ]]; then\n        _edsc_words \"{}\"\n      else\n        "
                   "{}\n      fi\n      ;;\n",
                   path_of(*command), fmt::join(options, " "), first_word(*command));
  }
  return out + tail;
}

}  // namespace edsc
