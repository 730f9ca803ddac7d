/// Standard input of a command that runs while nothing is entered. POSIX.
#pragma once

#include <cstdint>
#include <string>

namespace edsc {

enum class InputState : std::uint8_t { open, ended };

/// Appends what standard input has, without waiting. A process in the background does not read a terminal, which would
/// stop it. After the end, or if standard input cannot be read, the state is `ended`.
[[nodiscard]] InputState read_available_input(std::string& text);

}  // namespace edsc
