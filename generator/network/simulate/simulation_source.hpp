/// The C++ program that simulates a network (runtime/include/canopen_sim/network_simulation).
#pragma once

#include <string>
#include <vector>

#include "network/network.hpp"
#include "network/timing/timing.hpp"
#include "system/write_files.hpp"

namespace edsc {

struct SimulationSource {
  std::vector<OutputFile> files;     ///< headers and sources, relative to the output folder
  std::vector<std::string> sources;  ///< of `files`, those to compile: `simulate.cpp` and one for each device
};

/// Returns the headers of each distinct EDS of the network, and the sources of the program. Places of nodes and
/// messages in its output are those of `network.nodes` and `timing.messages`. Requires a network without errors;
/// reports devices that do not fit into the memory of a dictionary.
[[nodiscard]] SimulationSource simulation_source(const Network& network, const NetworkTiming& timing,
                                                 Diagnostics& diagnostics);

}  // namespace edsc
