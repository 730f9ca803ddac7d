/// Runs another program.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// Output of a program beyond this size is dropped.
inline constexpr std::size_t max_program_output_bytes = std::size_t{1} << 30U;

struct ProgramOutcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output;
  std::string errors;
};

/// Runs a program without a shell, and reads its output until its end; nothing if it cannot be started. `words` are its
/// name, which is looked up in PATH, and its arguments. Standard input is empty. `on_output` gets pieces of standard
/// output instead of `ProgramOutcome::output`. The program has the environment of edsc, changed by `variables`, each
/// NAME=VALUE.
[[nodiscard]] std::optional<ProgramOutcome> run_program(std::vector<std::string> words,
                                                        const std::function<void(std::string_view)>& on_output = {},
                                                        std::vector<std::string> variables = {});

/// Runs a command line of the user with the shell, with a variable of the environment. Returns whether it succeeds.
[[nodiscard]] bool run_command_line(const std::string& line, const std::string& variable, const std::string& value);

}  // namespace edsc
