#include "program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "diagnostics/quote.hpp"
#include "shared/command_line.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "system/standard_streams.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace {

/// Prefix of an argument in brackets. Without it, CLI11 reads `[a,b]` as a list of values for options with several
/// values.
constexpr char literal = '\x01';

std::string marked(std::string_view argument) {
  const bool is_list = argument.starts_with('[') && argument.ends_with(']');
  return (is_list || argument.starts_with(literal) ? std::string{literal} : std::string{}).append(argument);
}

std::string without_mark(std::string argument) {
  if (argument.starts_with(literal)) argument.erase(0, 1);
  return argument;
}

void take_marks_off(CLI::App& app) {
  for (CLI::Option* const option : app.get_options()) {
    if (option->get_items_expected_max() > 0) option->transform(without_mark);
  }
  for (CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; })) take_marks_off(*command);
}

/// Parses the arguments, each unchanged.
void parse(CLI::App& app, int argc, char** argv) {
  take_marks_off(app);
  std::vector<std::string> arguments;
  arguments.reserve(static_cast<std::size_t>(argc));
  for (int i = 0; i < argc; ++i) arguments.push_back(marked(argv[i]));
  std::vector<const char*> pointers;
  pointers.reserve(arguments.size());
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  app.parse(argc, pointers.data());
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); });
}

/// Reports the first word in the place of a command that is not a command; false if there is none.
bool report_unknown_command(const CLI::App& app) {
  for (const CLI::App* const chosen : app.get_subcommands()) {
    if (report_unknown_command(*chosen)) return true;
  }
  std::vector<std::string> names;
  for (const CLI::App* const command : commands_of(app)) names.push_back(command->get_name());
  const auto words = app.remaining(false);
  if (names.empty() || words.empty() || words.front().starts_with('-')) return false;
  const std::string word = without_mark(words.front());
  edsc::print_to_stderr("{}: unknown command {}{}\n", app.get_parent() == nullptr ? "edsc" : "edsc " + app.get_name(),
                        edsc::quote(word), edsc::did_you_mean(word, names));
  return true;
}

/// Prints the message of CLI11 about arguments, which may contain any characters.
std::string failure_message(const CLI::App* app, const CLI::Error& problem) {
  std::string message = CLI::FailureMessage::simple(app, problem);
  for (std::size_t at = 0; (at = message.find("\x01[", at)) != std::string::npos;) message.erase(at, 1);
  std::string shown;
  for (std::size_t begin = 0; begin < message.size();) {
    const std::size_t end = std::min(message.find('\n', begin), message.size());
    edsc::append_printable(shown, std::string_view{message}.substr(begin, end - begin));
    shown += '\n';
    begin = end + 1;
  }
  return shown;
}

/// Write errors of standard output are reported at the end.
int report(const std::exception& problem) {
  if (std::ferror(stdout) == 0) edsc::print_to_stderr("edsc: {}\n", problem.what());
  return edsc::exit_wrong_usage;
}

}  // namespace

namespace edsc {

int run_program(std::span<const CommandRow> rows, const std::string& version, int argc, char** argv) {
  occupy_standard_descriptors();
  CLI::App app{"edsc compiles CANopen Electronic Data Sheets (EDS, DCF) to checked C++20."};
  app.name("edsc");
  app.set_version_flag("--version", "edsc " + version);
  app.failure_message(failure_message);
  app.require_subcommand(1);
  app.footer("'edsc COMMAND --help' shows a command's options and examples.");
  int exit_code = exit_fine;
  for (const CommandRow& row : rows) {
    CLI::App* const command = app.add_subcommand(row.name, row.description);
    row.add_options(Command{*command}, exit_code);
    command->group(row.group);  // later, because subcommands inherit it
  }
  int output_error = 0;
  try {
    parse(app, argc, argv);
  } catch (const CLI::ParseError& problem) {
    if (report_unknown_command(app)) return exit_wrong_usage;
    errno = 0;
    exit_code = app.exit(problem) == 0 ? exit_fine : exit_wrong_usage;
    output_error = errno;
  } catch (const Exit& exit) {
    exit_code = exit.code;
  } catch (const std::system_error& problem) {
    output_error = problem.code().value();
    exit_code = report(problem);
  } catch (const std::exception& problem) {
    exit_code = report(problem);
  }
  return finish_output(output_error) ? exit_code : exit_wrong_usage;
}

}  // namespace edsc
