/// `edsc network generate`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "shared/common_options.hpp"

namespace edsc {

struct NetworkGenerateSettings {
  std::string path;
  std::string output;
  std::string depfile;
  std::string depfile_target;
  bool verbose = false;
  ColorOption color;
};

void add_network_generate_options(CLI::App& command, NetworkGenerateSettings& settings);

/// Returns the exit code.
[[nodiscard]] int run_network_generate(const NetworkGenerateSettings& settings);

}  // namespace edsc
