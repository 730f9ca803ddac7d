/// The subcommands of edsc, one file each: a new one is declared here and has a row in the table.
#pragma once

#include <CLI/CLI.hpp>

namespace edsc {

/// Each adds its subcommand; when that is chosen, parsing runs it and stores its exit code.
void add_generate_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_dump_command(CLI::App& app, int& exit_code);
void add_format_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);
void add_decode_command(CLI::App& app, int& exit_code);
/// Describes all subcommands of `app`, including those added later.
void add_completion_command(CLI::App& app, int& exit_code);
void add_bus_command(CLI::App& app, int& exit_code);
void add_scan_command(CLI::App& app, int& exit_code);
void add_read_command(CLI::App& app, int& exit_code);
void add_write_command(CLI::App& app, int& exit_code);
void add_configure_command(CLI::App& app, int& exit_code);
void add_save_command(CLI::App& app, int& exit_code);
void add_conform_command(CLI::App& app, int& exit_code);
void add_monitor_command(CLI::App& app, int& exit_code);
void add_record_command(CLI::App& app, int& exit_code);
void add_nmt_command(CLI::App& app, int& exit_code);
void add_lss_command(CLI::App& app, int& exit_code);

/// A command and the group that the help and the manual page list it in.
struct CommandRow {
  const char* group;
  void (*add)(CLI::App& app, int& exit_code);
};

/// In the order of the help.
inline constexpr CommandRow commands[] = {
    {"EDS files", add_generate_command},
    {"EDS files", add_check_command},
    {"EDS files", add_dump_command},
    {"EDS files", add_format_command},
    {"EDS files", add_diff_command},
    {"Bus", add_scan_command},
    {"Bus", add_read_command},
    {"Bus", add_write_command},
    {"Bus", add_configure_command},
    {"Bus", add_save_command},
    {"Bus", add_monitor_command},
    {"Bus", add_nmt_command},
    {"Bus", add_lss_command},
    {"Bus", add_conform_command},
    {"Bus", add_bus_command},
    {"Logs", add_record_command},
    {"Logs", add_decode_command},
    {"Shell", add_completion_command},
};

}  // namespace edsc
