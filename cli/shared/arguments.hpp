/// The arguments of the program before CLI11 reads them: old spellings, unknown commands and options, the default bus.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace edsc {

/// A command line that is wrong; `what()` says why.
class WrongUsage : public std::runtime_error {
 public:
  WrongUsage(const std::string& message, std::vector<std::string> wrong_command)
      : std::runtime_error{message}, command{std::move(wrong_command)} {}

  std::vector<std::string> command;  ///< whose help has the right form: `network`, `scan`
};

struct ReadArguments {
  std::vector<std::string> command;    ///< `network`, `scan`
  std::vector<std::string> arguments;  ///< for CLI11, in order
  bool wants_help = false;
  bool wants_version = false;
};

/// Whether a text has the form of an address of a bus, such as `socketcan:can0`.
[[nodiscard]] bool is_bus_address(const std::string& text);

/// Reads the arguments after the name of the program. Prints a note for each old spelling, and replaces it by the
/// present one. The first argument of a command for a bus is BUS if it is a bus address; otherwise BUS is EDSC_BUS.
/// Throws WrongUsage.
[[nodiscard]] ReadArguments read_arguments(const CLI::App& program, const std::vector<std::string>& arguments);

}  // namespace edsc
