/// What the network file and the DCF of a node state about its PDOs.
#pragma once

#include "device/device.hpp"
#include "network/network.hpp"

namespace edsc {

/// Whether `set` or the DCF states the CAN-ID or the mapping of a PDO with both parameters: a signal that needs another
/// one must not use the PDO.
[[nodiscard]] bool is_configured(const NetworkNode& node, const Pdo& pdo);

/// Whether neither a signal, `set` nor the DCF states a parameter of a PDO: it is as in the EDS.
[[nodiscard]] bool is_as_in_eds(const NetworkNode& node, const Pdo& pdo);

/// Whether `set` or the DCF states the CAN-ID of a PDO, and the PDO is valid.
[[nodiscard]] bool has_stated_can_id(const NetworkNode& node, const Pdo& pdo);

}  // namespace edsc
