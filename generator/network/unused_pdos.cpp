#include "network/unused_pdos.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <set>
#include <vector>

#include "device/pdo/pdo_defaults.hpp"
#include "network/cob_id_use.hpp"
#include "network/configured_pdo.hpp"
#include "network/node_settings.hpp"

namespace edsc {
namespace {

bool is_received(const CobIdUse& sent, const std::vector<CobIdUse>& uses) {
  return std::ranges::any_of(uses, [&](const CobIdUse& use) {
    return use.service == FrameService::pdo && !use.transmits && use.node != sent.node && use.can_id == sent.can_id &&
           use.extended == sent.extended;
  });
}

}  // namespace

void disable_unused_pdos(Network& network, Diagnostics& diagnostics) {
  const WrittenFlag& wish = network.description.disable_unused_pdos;
  if (!wish || !wish->value) return;
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  std::set<NetworkNode*> changed;
  for (const CobIdUse& use : uses) {
    if (use.service != FrameService::pdo || !use.transmits || is_received(use, uses)) continue;
    const Entry& cob_id = *use.pdo->communication->find(1);
    if (!is_as_in_eds(*use.node, *use.pdo) || !canopen::writable(cob_id.access)) continue;
    NetworkNode& node = network.nodes[static_cast<std::size_t>(use.node - network.nodes.data())];
    const std::uint64_t value = communication_default(*use.pdo, 1).value_or(0) | canopen::CobId::invalid_bit;
    set_number(node, cob_id.index, cob_id.sub_index, value, wish->position, diagnostics);
    changed.insert(&node);
  }
  for (NetworkNode* const node : changed) configure(*node, *network.source, diagnostics);
}

}  // namespace edsc
