/// Standard input, output and error of this process.
#pragma once

#include <cstdio>
#include <string_view>

namespace edsc {

/// Opens descriptors 0 to 2 if the caller has closed them, so that no file or bus gets their numbers. Writing to a
/// closed standard output fails. On Windows, bytes are read and written unchanged, a console shows UTF-8, and
/// interprets escape sequences if it can; its settings are restored at the end of the process.
void prepare_standard_streams();

[[nodiscard]] bool is_terminal(std::FILE* stream);

/// Whether the terminal understands no escape sequences: on Linux TERM states it.
[[nodiscard]] bool is_dumb_terminal();

/// From now on, writing to a pipe that its reader has closed fails with EPIPE and does not end the program.
void report_closed_pipes();

/// Writes text to standard error, immediately. Nothing happens if that is closed, is full, or is a pipe that its reader
/// has closed. All of edsc writes to standard error with this function.
void write_to_stderr(std::string_view text);

/// Writes text immediately, past the buffer of the stream, which must be empty. Returns 0, or the error number.
[[nodiscard]] int write_unbuffered(std::FILE* stream, std::string_view text);

}  // namespace edsc
