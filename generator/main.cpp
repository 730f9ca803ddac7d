/// edsc: the compiler for CANopen Electronic Data Sheets.
#include <fmt/format.h>

#include <exception>

#include "commands/commands.hpp"

int main(int argc, char** argv) {
  CLI::App app{"edsc compiles CANopen Electronic Data Sheets (EDS, DCF) to checked C++20."};
  app.name("edsc");
  app.set_version_flag("--version", "edsc " EDSC_VERSION);
  app.require_subcommand(1);
  app.footer("'edsc COMMAND --help' shows a command's options and examples.");
  int exit_code = edsc::exit_fine;
  edsc::add_generate_command(app, exit_code);
  edsc::add_check_command(app, exit_code);
  edsc::add_dump_command(app, exit_code);
  edsc::add_format_command(app, exit_code);
  edsc::add_diff_command(app, exit_code);
  edsc::add_decode_command(app, exit_code);
  edsc::add_completion_command(app, exit_code);
  edsc::add_bus_command(app, exit_code);
  edsc::add_scan_command(app, exit_code);
  edsc::add_read_command(app, exit_code);
  edsc::add_write_command(app, exit_code);
  edsc::add_configure_command(app, exit_code);
  edsc::add_monitor_command(app, exit_code);
  edsc::add_nmt_command(app, exit_code);
  edsc::add_lss_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? edsc::exit_fine : edsc::exit_wrong_usage;
  } catch (const std::exception& problem) {
    fmt::print(stderr, "edsc: {}\n", problem.what());
    return edsc::exit_wrong_usage;
  }
  return exit_code;
}
