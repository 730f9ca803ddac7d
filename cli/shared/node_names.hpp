/// The nodes that a network file names, and NODE as the user writes it: a node-ID or such a name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shared/command_line.hpp"

namespace edsc {

struct NamedNode {
  std::string name;
  std::uint8_t node_id = 0;
  std::string sheet;    ///< EDS or DCF; empty: the network file states none
  std::string options;  ///< options file; empty: the network file states none
};

/// `--network FILE`
Option add_network_option(Command command, std::string& network);

/// The network file: that of --network, or the one that the environment variable EDSC_NETWORK states; empty if there is
/// none.
[[nodiscard]] std::string network_or_default(const std::string& network);

/// The nodes with a node-ID, in the order of the file; none for an empty path. Ends the command if the file cannot be
/// read.
[[nodiscard]] std::vector<NamedNode> named_nodes(const std::string& network);

/// The node with this node-ID or name, and its files in the network file. A node-ID that the network file does not have
/// is a node without a name. `wants_files`: whether the files of a node that is given by its node-ID are needed.
/// Throws wrong usage of `argument`, such as `NODE`, if there is no such node.
[[nodiscard]] NamedNode find_node(const std::string& argument, const std::string& text, const std::string& network,
                                  bool wants_files);

/// The same for a command that needs only the node-ID.
[[nodiscard]] std::uint8_t find_node_id(const std::string& argument, const std::string& text,
                                        const std::string& network);

}  // namespace edsc
