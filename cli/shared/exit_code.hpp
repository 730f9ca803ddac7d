/// Exit codes of the commands (docs/command-line.md).
#pragma once

namespace edsc {

inline constexpr int exit_fine = 0;
inline constexpr int exit_input_has_errors = 1;
inline constexpr int exit_device_failed = 1;  ///< a device refused, did not answer or does not exist; the bus was lost
inline constexpr int exit_wrong_usage = 2;    ///< also: a file could not be read or written
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C or SIGTERM

}  // namespace edsc
