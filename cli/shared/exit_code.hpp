/// How a command ends: its exit code (docs/command-line.md) and its message.
#pragma once

#include <string_view>

#include "text/printable.hpp"

namespace edsc {

inline constexpr int exit_fine = 0;
inline constexpr int exit_input_has_errors = 1;
inline constexpr int exit_device_failed = 1;  ///< a device refused, did not answer or does not exist; the bus was lost
inline constexpr int exit_wrong_usage = 2;    ///< also: a file could not be read or written
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C or SIGTERM

/// Thrown to end the command, when the reason has been printed.
struct Exit {
  int code = exit_wrong_usage;
};

/// Ends the command with a message on standard error.
[[noreturn]] inline void fail(std::string_view message, int exit_code = exit_wrong_usage) {
  print_to_stderr("edsc: {}\n", message);
  throw Exit{exit_code};
}

}  // namespace edsc
