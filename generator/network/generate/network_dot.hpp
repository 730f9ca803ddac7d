/// The PDOs of a network as a graph.
#pragma once

#include <string>

#include "network/network.hpp"

namespace edsc {

/// A graph in the language of Graphviz: a box for each node, and an arrow from the transmitter to the receiver for each
/// TPDO with an RPDO of the same CAN-ID, with the objects that it sends.
[[nodiscard]] std::string network_dot(const Network& network);

}  // namespace edsc
