/// What a command at a live bus ends with besides `exit_fine` and `exit_wrong_usage` (docs/command-line.md).
#pragma once

namespace edsc {

inline constexpr int exit_device_failed = 1;  ///< a device refused, did not answer or is not there; the bus was lost
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C or SIGTERM

}  // namespace edsc
