/// Compiles and runs the program of a simulation.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "simulate/simulation_fault.hpp"
#include "simulate/simulation_result.hpp"

namespace edsc {

/// The program cannot be compiled or has failed; with a message.
struct SimulationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the include folder of the runtime that belongs to this program: as installed, or of its source tree. Empty
/// if there is none.
[[nodiscard]] std::string runtime_include_folder();

struct SimulationBuild {
  std::string folder;                ///< with the files of SimulationSource
  std::vector<std::string> sources;  ///< relative to it
  std::string include_folder;        ///< of the runtime
};

/// Compiles the sources with `$CXX`, default `c++`, several at a time, and links `simulate` in the folder. Objects of
/// an earlier build whose files and command are the same are used again. `progress` gets the number of compiled
/// sources. Returns the path of the program. Throws SimulationError.
[[nodiscard]] std::string build_simulation(const SimulationBuild& build,
                                           const std::function<void(std::size_t)>& progress);

struct SimulationRun {
  std::string program;
  std::uint64_t duration_us = 0;
  std::uint32_t seed = 1;
  std::vector<SimulationFault> faults;
  std::size_t nodes = 0;
  std::size_t messages = 0;
};

/// Runs the program. `progress` gets the simulated time in us. Throws SimulationError.
[[nodiscard]] SimulationResult run_simulation(const SimulationRun& run,
                                              const std::function<void(std::uint64_t)>& progress);

}  // namespace edsc
