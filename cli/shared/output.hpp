/// Standard output, whose errors are errors of the command.
#pragma once

#include <string_view>

namespace edsc {

/// Opens descriptors 0 to 2 where the caller has closed them, so that no file or bus gets their numbers. Writing to a
/// standard output that was closed fails.
void occupy_standard_descriptors();

/// Writes what is left in the buffers of standard output. False if standard output did not take all that was written to
/// it; that is reported on standard error. `error_number` says why, where a write has failed before; else 0.
[[nodiscard]] bool finish_output(int error_number);

/// Throws std::system_error if standard output does not take the text.
void write_output(std::string_view text);

/// Writes what is in the buffers of standard output now, for commands that run until they are interrupted. Throws
/// std::system_error if standard output does not take it.
void flush_output();

}  // namespace edsc
