/// Checks of a network.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "network/network.hpp"

namespace edsc {

/// Reports what the nodes of the network do to each other: CAN-IDs, PDO links, SYNC, error control, load and response
/// times. The nodes themselves were checked when they were loaded.
void check_network(const Network& network, Diagnostics& diagnostics);

}  // namespace edsc
