/// Standard output; write errors are errors of the command.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "system/write_files.hpp"

namespace edsc {

/// Flushes standard output. Returns false if any output was lost, which is reported on standard error. `error_number`
/// is that of an earlier failed write, or 0.
[[nodiscard]] bool finish_output(int error_number);

/// Throws std::system_error on a write error.
void write_output(std::string_view text);

/// Writes a file, or standard output if the path is empty. Ends the command if it cannot be written, or is one of
/// `inputs`.
void write_output(const std::string& path, std::string text, const std::vector<std::string>& inputs = {});

/// Writes all files or none; ends the command if one of them cannot be written, or is one of `inputs`.
void write_all_files(const std::vector<OutputFile>& files, const std::vector<std::string>& inputs = {});

/// Ends the command if a file that it writes piece by piece is one of `inputs`, by whatever name. Empty names are none.
void refuse_input(const std::string& path, const std::vector<std::string>& inputs);

/// Flushes standard output immediately, for commands that run until they are interrupted. Throws std::system_error on a
/// write error.
void flush_output();

}  // namespace edsc
