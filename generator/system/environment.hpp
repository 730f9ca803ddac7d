/// What the caller of this process has given it: arguments, variables, and the place of the program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace edsc {

/// The arguments of main() without the name of the program, as UTF-8 on Windows.
[[nodiscard]] std::vector<std::string> program_arguments(int argc, char** argv);

/// A variable of the environment, as UTF-8 on Windows; nothing if it is not set.
[[nodiscard]] std::optional<std::string> environment_variable(const char* name);

/// The file of this program; empty if the system does not state it.
[[nodiscard]] std::filesystem::path program_file();

}  // namespace edsc
