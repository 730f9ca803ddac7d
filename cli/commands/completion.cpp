#include <fmt/format.h>

#include <optional>
#include <string>

#include "commands/commands.hpp"
#include "completion/command_parts.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  source <(edsc completion bash)               completion in this shell; an installed edsc includes it
  edsc completion zsh >~/.zfunc/_edsc          for zsh, in a folder of its fpath
  edsc completion man | man -l -               the manual page)";

struct Settings {
  std::optional<Command> program;
  std::string kind;
};

std::string text_of(const Settings& settings) {
  const CommandParts program = parts_of(*settings.program);
  if (settings.kind == "bash") return bash_completion(program);
  if (settings.kind == "zsh") return zsh_completion(program);
  return man_page(program, EDSC_VERSION);
}

int run_completion(const Settings& settings) {
  fmt::print("{}", text_of(settings));
  return exit_fine;
}

}  // namespace

void add_completion_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_completion, exit_code);
  settings.program = command.parent();
  command.add_option("KIND", settings.kind, "what to print").required().one_of({"bash", "zsh", "man"});
}

}  // namespace edsc
