/// The files that `edsc network generate` writes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// The program that is the master of the network.
enum class MasterProgram : std::uint8_t {
  edsc,  ///< canopen::Plant, or any other one that reads DCFs as CiA 306 describes them
  lely,  ///< Lely's CANopen library, also in ros2_canopen
};

struct GeneratedNetwork {
  std::vector<OutputFile> files;    ///< relative to the output folder
  std::vector<std::string> inputs;  ///< the network file, EDS, DCF and options files
  std::vector<std::string> notes;   ///< what files cannot contain: `not in the DBC file: TPDO 3: disabled by default`
};

/// Returns DCF and concise DCF of each node, the EDS of a master without a file, DBC file and graph of the network, and
/// its C++ headers; for Lely `bus.yml` as well, and the DCF of the master as its loader accepts it.
/// Requires a network without errors; reports values that a DCF cannot express, and a network for Lely without a
/// master.
[[nodiscard]] GeneratedNetwork generate_network(const Network& network, Diagnostics& diagnostics,
                                                MasterProgram program = MasterProgram::edsc);

}  // namespace edsc
