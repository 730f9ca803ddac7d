#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <iterator>

#include "completion/command_description.hpp"

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

using Visit = std::function<void(const CommandDescription&)>;

void for_each(const CommandDescription& command, const Visit& visit) {
  visit(command);
  for (const CommandDescription& sub : command.commands) for_each(sub, visit);
}

std::string path_of(const CommandDescription& command) { return fmt::format("{}", fmt::join(command.path, " ")); }

std::string values_of(const OptionDescription& option) {
  switch (option.value) {
    case ValueKind::words: return fmt::format("_edsc_words \"{}\"", fmt::join(option.words, " "));
    case ValueKind::folder: return "_edsc_files -d";
    case ValueKind::file: return "_edsc_files -f";
    case ValueKind::none:
    case ValueKind::number: break;
  }
  return ":";
}

}  // namespace

std::string bash_completion(const CommandDescription& program) {
  std::string out = head;
  const auto put = std::back_inserter(out);
  for_each(program, [&](const CommandDescription& command) {
    for (const CommandDescription& sub : command.commands) {
      fmt::format_to(put, "      \"{}/{}\") command=\"{}\" ;;\n", path_of(command), sub.path.back(), path_of(sub));
    }
  });
  out += "    esac\n  done\n  case \"$command/$previous\" in\n";
  for_each(program, [&](const CommandDescription& command) {
    for (const OptionDescription& option : command.options) {
      if (option.value == ValueKind::none) continue;
      std::string patterns;
      for (const std::string& name : option.names) {
        patterns += fmt::format("{}\"{}/{}\"", patterns.empty() ? "" : " | ", path_of(command), name);
      }
      fmt::format_to(put, "    {}) {}; return ;;\n", patterns, values_of(option));
    }
  });
  out += "  esac\n  case \"$command\" in\n";
  for_each(program, [&](const CommandDescription& command) {
    std::string options, commands;
    for (const OptionDescription& option : command.options) {
      for (const std::string& name : option.names) options += (options.empty() ? "" : " ") + name;
    }
    for (const CommandDescription& sub : command.commands) commands += (commands.empty() ? "" : " ") + sub.path.back();
    const std::string words = command.arguments.empty() ? ":" : values_of(command.arguments.front());
    fmt::format_to(put,
                   "    \"{}\")\n      if [[ $current == -* ]]; then\n        _edsc_words \"{}\"\n      else\n        "
                   "{}\n      fi\n      ;;\n",
                   path_of(command), options, commands.empty() ? words : fmt::format("_edsc_words \"{}\"", commands));
  });
  return out + tail;
}

}  // namespace edsc
