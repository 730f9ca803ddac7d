#include "network/checks/check_network.hpp"

#include "network/checks/check_groups.hpp"

namespace edsc {

/// The other checks follow from the node-IDs.
void check_network(const Network& network, Diagnostics& diagnostics) {
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  const NetworkContext context{network, uses, diagnostics};
  if (network.nodes.empty() || !check_node_ids(context)) return;
  for (auto* const check :
       {check_nodes, check_settings, check_cob_ids, check_pdo_links, check_sync, check_error_control, check_timing}) {
    check(context);
  }
}

}  // namespace edsc
