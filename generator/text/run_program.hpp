/// Runs another program.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

struct ProgramOutcome {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output;
  std::string errors;
};

/// Runs a program without a shell, and reads its output until its end; nothing if it cannot be started. `words` are its
/// name, which is looked up in PATH, and its arguments. Standard input is empty. `on_output` gets pieces of standard
/// output instead of `ProgramOutcome::output`. Output beyond `SourceFile::max_bytes` is dropped.
[[nodiscard]] std::optional<ProgramOutcome> run_program(std::vector<std::string> words,
                                                        const std::function<void(std::string_view)>& on_output = {});

}  // namespace edsc
