#include "program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "completion/command_parts.hpp"
#include "diagnostics/quote.hpp"
#include "shared/arguments.hpp"
#include "shared/command_line.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"
#include "shared/vocabulary.hpp"
#include "system/path.hpp"
#include "system/standard_streams.hpp"
#include "text/printable.hpp"

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

/// Inside edsc, a path has `/` between its folders.
std::string with_slashes(const std::string& argument) { return edsc::from_native(edsc::to_native(argument)); }

/// Takes the marks off, and gives all paths one form. CLI11 calls the last function first.
void prepare_values(CLI::App& app) {
  using enum edsc::OptionValueKind;
  for (CLI::Option* const option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;
    const edsc::OptionValueKind kind = edsc::facts_of(*option).kind;
    if (kind == file || kind == folder || kind == path || kind == node_file) option->transform(with_slashes);
    option->transform(without_mark);
  }
  for (CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; })) prepare_values(*command);
}

/// Parses the arguments, each unchanged.
void parse(CLI::App& app, const std::vector<std::string>& words) {
  prepare_values(app);
  std::vector<std::string> arguments;
  arguments.reserve(words.size());
  for (auto word = words.rbegin(); word != words.rend(); ++word) arguments.push_back(marked(*word));
  app.parse(std::move(arguments));  // in reverse order
}

/// Arguments that no option and no argument of the command takes.
std::string extra_arguments(const CLI::App& app) {
  std::vector<std::string> words = app.remaining(true);
  std::erase(words, "--");
  return words.empty() ? std::string{} : "unexpected argument " + edsc::quote(without_mark(words.front()));
}

/// The message of CLI11, which may contain marks.
std::string message_of(const CLI::App& app, const CLI::ParseError& problem) {
  if (dynamic_cast<const CLI::ExtrasError*>(&problem) != nullptr) return extra_arguments(app);
  std::string message = problem.what();
  for (std::size_t at = 0; (at = message.find("\x01[", at)) != std::string::npos;) message.erase(at, 1);
  if (dynamic_cast<const CLI::ExcludesError*>(&problem) != nullptr) {
    constexpr std::string_view verb = " excludes ";
    if (const std::size_t at = message.find(verb); at != std::string::npos) {
      message.replace(at, verb.size(), " cannot be combined with ");
    }
  }
  if (message == "BUS is required") message += "; the environment variable EDSC_BUS states the default";
  return message;
}

int report_wrong_usage(const std::string& message, const std::vector<std::string>& command) {
  edsc::print_to_stderr("edsc: {}\n", message);
  edsc::print_to_stderr("\"edsc help{}{}\" shows the usage\n", command.empty() ? "" : " ",
                        fmt::format("{}", fmt::join(command, " ")));
  return edsc::exit_wrong_usage;
}

/// Write errors of standard output are reported at the end.
int report(const std::exception& problem) {
  if (std::ferror(stdout) == 0) edsc::print_to_stderr("edsc: {}\n", problem.what());
  return edsc::exit_wrong_usage;
}

/// Runs the command. Throws what it throws, and CLI::ParseError.
int run(CLI::App& app, const edsc::ReadArguments& read, const int& exit_code) {
  if (read.wants_version) {
    edsc::write_output(app.version() + "\n");
  } else if (read.wants_help) {
    const edsc::CommandParts program = edsc::parts_of(edsc::Command{app});
    edsc::write_output(edsc::help_text(*edsc::find_command(program, read.command)));
  } else if (read.command.empty()) {
    edsc::print_to_stderr("edsc: a command is missing\n");
    edsc::write_to_stderr(edsc::short_help(edsc::parts_of(edsc::Command{app})));
    return edsc::exit_wrong_usage;
  } else {
    parse(app, read.arguments);
  }
  return exit_code;
}

/// Returns the only command whose options are needed; null: all of them, as for help or a command that does not exist.
const edsc::CommandRow* only_command(std::span<const edsc::CommandRow> rows, const std::vector<std::string>& words) {
  if (words.empty()) return nullptr;
  const auto found = std::ranges::find(rows, std::string_view{words.front()},
                                       [](const edsc::CommandRow& row) { return std::string_view{row.name}; });
  return found == rows.end() || found->describes_all ? nullptr : &*found;
}

}  // namespace

namespace edsc {

int run_program(std::span<const CommandRow> rows, const std::string& version,
                const std::vector<std::string>& arguments) {
  prepare_standard_streams();
  CLI::App app{"edsc compiles CANopen Electronic Data Sheets (EDS, DCF) to checked C++20."};
  app.name("edsc");
  app.set_help_flag("-h,--help", std::string{find_command_option("--help")->meaning});
  app.set_version_flag("-V,--version", "edsc " + version, std::string{find_command_option("--version")->meaning});
  app.require_subcommand(1);
  int exit_code = exit_fine;
  const CommandRow* const only = only_command(rows, arguments);
  for (const CommandRow& row : rows) {
    CLI::App* const command = app.add_subcommand(row.name, row.description);
    if (only == nullptr || only == &row) row.add_options(Command{*command}, exit_code);
    command->group(row.group);  // later, because subcommands inherit it
  }
  int output_error = 0;
  ReadArguments read;
  try {
    read = read_arguments(app, arguments);
    exit_code = run(app, read, exit_code);
  } catch (const WrongUsage& problem) {
    exit_code = report_wrong_usage(problem.what(), problem.command);
  } catch (const CLI::ParseError& problem) {
    exit_code = report_wrong_usage(message_of(app, problem), read.command);
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
