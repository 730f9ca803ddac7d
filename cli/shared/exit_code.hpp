/// Exit codes of the commands (docs/command-line.md).
#pragma once

namespace edsc {

enum ExitCode : int {
  exit_fine = 0,
  exit_input_has_errors = 1,
  exit_device_failed = 1,  ///< a device refused, did not answer or is missing; the bus was lost
  exit_wrong_usage = 2,    ///< also: a file could not be read or written
  exit_interrupted = 130,  ///< Ctrl-C or SIGTERM
};

}  // namespace edsc
