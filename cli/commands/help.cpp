#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "commands/commands.hpp"
#include "completion/command_parts.hpp"
#include "diagnostics/quote.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc help                    all commands
  edsc help network check      one of them)";

struct Settings {
  std::optional<Command> program;
  std::vector<std::string> words;
};

int run_help(const Settings& settings) {
  const CommandParts program = parts_of(*settings.program);
  const CommandParts* command = &program;
  for (const std::string& word : settings.words) {
    const CommandParts* const next = find_command(*command, {&word, 1});
    if (next == nullptr) {
      std::vector<std::string> names;
      for (const CommandParts& sub : command->subcommands) names.push_back(sub.name);
      fail(fmt::format("unknown command {}{}{}", quote(word),
                       command->path.empty() ? "" : " of edsc " + command->path_with(" "), did_you_mean(word, names)));
    }
    command = next;
  }
  write_output(help_text(*command));
  return exit_fine;
}

}  // namespace

void add_help_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_help, exit_code);
  settings.program = command.parent();
  command.add_option("COMMAND", settings.words, "the words of a command (default: all commands)");
}

}  // namespace edsc
