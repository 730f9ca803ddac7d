#include <fmt/format.h>

#include <memory>

#include "commands/commands.hpp"
#include "completion/command_description.hpp"
#include "shared/exit_code.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  source <(edsc completion bash)               completion in this shell; an installed edsc includes it
  edsc completion zsh >~/.zfunc/_edsc          for zsh, in a folder of its fpath
  edsc completion man | man -l -               the manual page)";

std::string text_of(const std::string& kind, const CommandDescription& program) {
  if (kind == "bash") return bash_completion(program);
  if (kind == "zsh") return zsh_completion(program);
  return man_page(program, EDSC_VERSION);
}

}  // namespace

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("completion", "print the completion for a shell, or the manual page");
  command->footer(examples);
  auto kind = std::make_shared<std::string>();
  command->add_option("KIND", *kind, "what to print")->required()->check(CLI::IsMember({"bash", "zsh", "man"}));
  command->callback([kind, &app, &exit_code] {
    fmt::print("{}", text_of(*kind, describe_commands(app)));
    exit_code = exit_fine;
  });
}

}  // namespace edsc
