/// What all commands have in common.
#pragma once

#include <memory>

#include "shared/command_line.hpp"

namespace edsc {

/// Gives a command its examples and its settings, which the options fill in. When the command is chosen, `run` gets
/// them and returns the exit code; before, `resolve()` of the settings, if they have it, finds the nodes that the user
/// names. The settings live as long as the command.
template <class Settings>
Settings& define_command(Command command, const char* examples, int (*run)(const Settings&), int& exit_code) {
  command.footer(examples);
  const auto settings = std::make_shared<Settings>();
  command.on_chosen([settings, run, &exit_code] {
    if constexpr (requires { settings->resolve(); }) settings->resolve();
    exit_code = run(*settings);
  });
  return *settings;
}

}  // namespace edsc
