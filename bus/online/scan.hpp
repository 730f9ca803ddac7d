/// Which nodes are on a bus: those that answer over SDO, and those that send heartbeats.
#pragma once

#include <canopen/lss_protocol.hpp>
#include <canopen/nmt.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "online/live_bus.hpp"

namespace edsc {

struct ScanSettings {
  std::vector<std::uint8_t> nodes;  ///< ascending, 1..127
  unsigned timeout_ms = 250;        ///< for each answer
  unsigned listen_ms = 1200;        ///< at least; a known heartbeat is waited for in any case
};

/// What a node says of itself. Nothing where it has no such object, or does not answer.
struct FoundNode {
  std::uint8_t node_id = 0;
  bool answers_sdo = false;
  std::optional<canopen::NmtState> state;  ///< as error control has told it
  std::optional<std::uint32_t> device_type, vendor_id, product_code, revision_number, serial_number;
  std::optional<std::uint32_t> heartbeat_ms;  ///< 1017h
  std::optional<std::string> name;            ///< 1008h
};

/// Fills in the nodes that were found, ascending, also before it throws. Throws Interrupted, BusLost.
void scan(LiveBus& bus, const ScanSettings& settings, std::vector<FoundNode>& found);

}  // namespace edsc
