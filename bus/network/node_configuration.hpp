/// The values that a network file gives a node, and the identity that it expects.
#pragma once

#include <set>
#include <string>

#include "configure/configuration_values.hpp"
#include "diagnostics/diagnostics.hpp"
#include "network/cob_id_use.hpp"
#include "network/network.hpp"
#include "online/identity.hpp"

namespace edsc {

/// The PDOs that another node of the network sends or receives.
[[nodiscard]] std::set<const Pdo*> linked_pdos(const Network& network);

/// The values that the node shall have: the ParameterValues of its DCF, replaced by the settings of the network file. A
/// PDO in `linked`, or with one of these values, has all its parameters, since the checks of the network assume their
/// default values; 1005h also, if the network states a SYNC producer. The result refers to `network`.
[[nodiscard]] Configuration configuration_of(const Network& network, const NetworkNode& node,
                                             const std::set<const Pdo*>& linked, Diagnostics& diagnostics);

/// The identity of the EDS or DCF, with the serial number of the network file.
[[nodiscard]] Identity expected_identity(const NetworkNode& node);

/// The line of the first number of the identity that differs: in the network file or the file of the node.
[[nodiscard]] Position place_of_difference(const NetworkNode& node, const Identity& expected, const Identity& found);

/// `node axis1 (5)`
[[nodiscard]] std::string label(const NetworkNode& node);

/// The path of the EDS or DCF, as in the network file.
[[nodiscard]] const std::string& file_of(const NetworkNode& node);

}  // namespace edsc
