/// TPDOs of an EDS that no node of a network receives.
#pragma once

#include "network/network.hpp"

namespace edsc {

/// If the network file wishes so, disables each TPDO that is as in the EDS and that no other node receives: bit 31 of
/// its COB-ID. One whose COB-ID cannot be written stays enabled; the rule `network-pdo-unreceived` reports it.
void disable_unused_pdos(Network& network, Diagnostics& diagnostics);

}  // namespace edsc
