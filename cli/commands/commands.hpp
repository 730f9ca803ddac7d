/// The subcommands of edsc, one file each: a new one is declared here and has a row in the table.
#pragma once

#include "shared/command_line.hpp"

namespace edsc {

/// Each adds the options and examples of its command; when that is chosen, parsing runs it and stores its exit code.
using AddOptions = void(Command command, int& exit_code);

AddOptions add_generate_options;
AddOptions add_check_options;
AddOptions add_dump_options;
AddOptions add_format_options;
AddOptions add_merge_options;
AddOptions add_edit_options;
AddOptions add_new_options;
AddOptions add_object_options;
AddOptions add_overlay_options;
AddOptions add_overlay_from_bus_options;
AddOptions add_diff_options;
AddOptions add_document_options;
AddOptions add_lsp_options;
AddOptions add_network_options;
AddOptions add_scan_options;
AddOptions add_read_options;
AddOptions add_write_options;
AddOptions add_configure_options;
AddOptions add_save_options;
AddOptions add_monitor_options;
AddOptions add_watch_options;
AddOptions add_nmt_options;
AddOptions add_send_options;
AddOptions add_lss_options;
AddOptions add_conform_options;
AddOptions add_accept_options;
AddOptions add_bus_options;
AddOptions add_node_options;
AddOptions add_record_options;
AddOptions add_replay_options;
AddOptions add_discover_options;
AddOptions add_decode_options;
AddOptions add_plot_options;
AddOptions add_audit_options;
AddOptions add_completion_options;
AddOptions add_help_options;
AddOptions add_version_options;

// Subcommands of `network`.
AddOptions add_network_apply_options;
AddOptions add_network_generate_options;
AddOptions add_network_run_options;
AddOptions add_network_scan_options;
AddOptions add_network_simulate_options;
AddOptions add_network_verify_options;

/// A command, and the group that the help and the manual page list it in.
struct CommandRow {
  const char* group;
  const char* name;
  const char* description;
  AddOptions* add_options;
  bool describes_all = false;  ///< it prints the options of all commands
};

/// In the order of the help. A program without access to a bus (EDSC_OFFLINE of CMake) does not have those for a bus,
/// and no servers.
inline constexpr CommandRow commands[] = {
    {"EDS files", "generate", "generate C++ headers for one device", add_generate_options},
    {"EDS files", "check", "check EDS, DCF and XDD files", add_check_options},
    {"EDS files", "dump", "print the resolved device as JSON", add_dump_options},
    {"EDS files", "format", "write an EDS or DCF in canonical form; make DCFs; convert XDD and XDC",
     add_format_options},
    {"EDS files", "new", "write an EDS for a new device", add_new_options},
    {"EDS files", "object", "add, change, map and remove objects of an EDS or DCF", add_object_options},
#ifndef EDSC_OFFLINE
    {"EDS files", "edit", "edit an EDS, DCF, overlay or network file in the browser", add_edit_options},
#endif
    {"EDS files", "merge", "merge two versions of an EDS or DCF, as a merge driver of git", add_merge_options},
    {"EDS files", "overlay", "correct an EDS that you may not change: apply, derive and rebase overlays",
     add_overlay_options},
    {"EDS files", "diff", "compare two EDS files; report breaking changes", add_diff_options},
    {"EDS files", "document", "write a device or a network as an HTML page or as Markdown", add_document_options},
    {"EDS files", "lsp", "language server for editors: findings, completion and quick fixes while you type",
     add_lsp_options},
    {"Networks", "network", "check, generate, simulate, verify, configure and run a network", add_network_options},
#ifndef EDSC_OFFLINE
    {"Bus", "scan", "find and identify the nodes on a bus", add_scan_options},
    {"Bus", "read", "read objects of a node over SDO", add_read_options},
    {"Bus", "write", "write an object of a node over SDO", add_write_options},
    {"Bus", "configure", "write the values of a DCF that differ from the values of a node", add_configure_options},
    {"Bus", "save", "read the configuration of a node and write it as a DCF", add_save_options},
    {"Bus", "monitor", "show nodes, states, PDO values, rates and load of a bus, live", add_monitor_options},
    {"Bus", "watch", "raise an alarm for what a network file does not allow on its bus", add_watch_options},
    {"Bus", "nmt", "start, stop or reset nodes", add_nmt_options},
    {"Bus", "send", "send SYNC, TIME, a PDO or a frame, once or periodically", add_send_options},
    {"Bus", "lss", "configure node-ID and bit rate of devices (CiA 305)", add_lss_options},
    {"Bus", "conform", "test a node against CiA 301 and its EDS", add_conform_options},
    {"Bus", "accept", "compare a node with its EDS and test it; acceptance report", add_accept_options},
    {"Bus", "bus", "virtual CAN buses on this machine, for socketcand clients", add_bus_options},
    {"Bus", "node", "run an EDS, DCF or XDD as a node of a bus", add_node_options},
    {"Logs", "record", "write the frames of a bus as a candump log", add_record_options},
    {"Logs", "replay", "send the requests of a log to nodes again; report different responses", add_replay_options},
    {"Logs", "discover", "describe an unknown bus by its frames, and write a network file", add_discover_options},
#endif
    {"Logs", "decode", "decode the frames of a log", add_decode_options},
    {"Logs", "audit", "check a log against the EDS files of its nodes", add_audit_options},
    {"Logs", "plot", "plot values of a log over time, as SVG", add_plot_options},
    {"Shell", "completion", "print the completion for a shell, or the manual page", add_completion_options, true},
    {"Shell", "help", "show the options and examples of a command", add_help_options, true},
    {"Shell", "version", "print the version", add_version_options},
};

}  // namespace edsc
