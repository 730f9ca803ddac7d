/// Standard output; write errors are errors of the command.
#pragma once

#include <string_view>

namespace edsc {

/// Opens descriptors 0 to 2 if the caller has closed them, so that no file or bus gets their numbers. Writing to a
/// closed standard output fails.
void occupy_standard_descriptors();

/// Flushes standard output. Returns false if any output was lost, which is reported on standard error. `error_number`
/// is that of an earlier failed write, or 0.
[[nodiscard]] bool finish_output(int error_number);

/// Throws std::system_error on a write error.
void write_output(std::string_view text);

/// Flushes standard output immediately, for commands that run until they are interrupted. Throws std::system_error on a
/// write error.
void flush_output();

}  // namespace edsc
