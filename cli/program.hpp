/// The program: it reads the command line, runs the chosen command and reports what failed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "commands/commands.hpp"

namespace edsc {

/// `arguments` do not include the name of the program. Returns the exit code.
int run_program(std::span<const CommandRow> rows, const std::string& version,
                const std::vector<std::string>& arguments);

}  // namespace edsc
