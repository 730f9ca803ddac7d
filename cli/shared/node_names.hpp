/// The nodes that a network file names, for completions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edsc {

struct NamedNode {
  std::string name;
  std::uint8_t node_id = 0;
  std::string sheet;  ///< EDS or DCF; empty: the network file states none
};

/// The network file that the environment states: EDSC_NETWORK; empty if it is not set.
[[nodiscard]] std::string default_network();

/// The nodes with a node-ID, in the order of the file; none for an empty path. Ends the command if the file cannot be
/// read.
[[nodiscard]] std::vector<NamedNode> named_nodes(const std::string& network);

}  // namespace edsc
