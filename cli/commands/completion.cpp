#include <fmt/format.h>

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
  const CLI::App* program = nullptr;
  std::string kind;
};

std::string text_of(const Settings& settings) {
  if (settings.kind == "bash") return bash_completion(*settings.program);
  if (settings.kind == "zsh") return zsh_completion(*settings.program);
  return man_page(*settings.program, EDSC_VERSION);
}

int run_completion(const Settings& settings) {
  fmt::print("{}", text_of(settings));
  return exit_fine;
}

}  // namespace

void add_completion_options(CLI::App& command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_completion, exit_code);
  settings.program = command.get_parent();
  command.add_option("KIND", settings.kind, "what to print")->required()->check(CLI::IsMember({"bash", "zsh", "man"}));
}

}  // namespace edsc
