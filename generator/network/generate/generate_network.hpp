/// The files that `edsc network generate` writes.
#pragma once

#include <string>
#include <vector>

#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

struct GeneratedNetwork {
  std::vector<OutputFile> files;    ///< relative to the output folder
  std::vector<std::string> inputs;  ///< the network file, EDS, DCF and options files
  std::vector<std::string> notes;   ///< PDOs that are not in the DBC file
};

/// Returns DCF and concise DCF of each node, the EDS of a master without a file, DBC file and graph of the network, and
/// its C++ headers.
/// Requires a network without errors; reports values that a DCF cannot express.
[[nodiscard]] GeneratedNetwork generate_network(const Network& network, Diagnostics& diagnostics);

}  // namespace edsc
