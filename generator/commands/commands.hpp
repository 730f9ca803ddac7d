/// The subcommands of edsc, one file each.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// What a command ends with (docs/command-line.md).
enum ExitCode : int {
  exit_fine = 0,
  exit_input_has_errors = 1,
  exit_wrong_usage = 2,  ///< also: a file could not be read or written
};

/// Each adds its subcommand; when that is chosen, parsing runs it and stores its exit code.
void add_generate_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_dump_command(CLI::App& app, int& exit_code);
void add_format_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);
void add_decode_command(CLI::App& app, int& exit_code);
/// Describes all subcommands of `app`, also those that are added later.
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

/// `--color auto|always|never`, and what it comes to on this stream.
struct ColorOption {
  std::string when = "auto";
  void add_to(CLI::App& command);
  [[nodiscard]] bool on(std::FILE* stream) const;
};

/// Prints findings as text to a stream, `with_allowed` with the number of those that are allowed.
void print_findings(std::FILE* stream, const Diagnostics& diagnostics, const ColorOption& color, bool with_allowed = false);

/// What `--keep-going` does, of each command that has it.
inline constexpr const char* keep_going_help =
    "for the file of another manufacturer: its errors are warnings, and what is wrong is left out";

/// A node-ID option, checked to be 1..127.
void add_node_id_option(CLI::App& command, std::optional<std::uint8_t>& node_id);

}  // namespace edsc
