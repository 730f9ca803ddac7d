/// The groups of checks of a network.
#pragma once

#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "network/cob_id_use.hpp"
#include "network/network.hpp"

namespace edsc {

struct NetworkContext {
  const Network& network;
  const std::vector<CobIdUse>& uses;
  Diagnostics& diagnostics;
};

/// Whether each node has its own node-ID; reports those with the node-ID of another.
[[nodiscard]] bool check_node_ids(const NetworkContext& context);
/// Node-IDs of DCFs, bit rate, length of the bus, LSS addresses.
void check_nodes(const NetworkContext& context);
/// Values of the network file, by the rules of single devices.
void check_settings(const NetworkContext& context);
/// CAN-IDs of all nodes against each other, and restricted ones.
void check_cob_ids(const NetworkContext& context);
/// TPDOs and the RPDOs that receive them.
void check_pdo_links(const NetworkContext& context);
/// SYNC and TIME.
void check_sync(const NetworkContext& context);
/// NMT master, heartbeat, node guarding.
void check_error_control(const NetworkContext& context);
/// Load, response times, synchronous window.
void check_timing(const NetworkContext& context);

}  // namespace edsc
