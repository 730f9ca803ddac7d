/// The program: it reads the command line, runs the chosen command and reports what failed.
#pragma once

#include <span>
#include <string>

#include "commands/commands.hpp"

namespace edsc {

/// Returns the exit code.
int run_program(std::span<const CommandRow> rows, const std::string& version, int argc, char** argv);

}  // namespace edsc
