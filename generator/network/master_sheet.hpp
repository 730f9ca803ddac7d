/// The EDS of a master without a file, from the network file.
#pragma once

#include <string>
#include <vector>

#include "network/assign_signals.hpp"
#include "network/network.hpp"

namespace edsc {

/// Gives the node a device with the objects that it needs in this network: SYNC, heartbeat producer and consumers, an
/// SDO client for each other node, PDOs and their data, and the list of slaves of CiA 302-2.
void add_master_sheet(NetworkNode& master, Network& network, const SignalPlan& plan);

}  // namespace edsc
