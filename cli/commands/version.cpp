#include <optional>

#include "commands/commands.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc version      with the commit, if it was built in a git repository)";

struct Settings {
  std::optional<Command> program;
};

int print_version(const Settings& settings) {
  write_output(settings.program->version() + "\n");
  return exit_fine;
}

}  // namespace

void add_version_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, print_version, exit_code);
  settings.program = command.parent();
}

}  // namespace edsc
