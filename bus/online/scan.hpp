/// Finds the nodes on a bus: those that answer over SDO, and those that send heartbeats.
#pragma once

#include <canopen/lss/lss_protocol.hpp>
#include <canopen/nmt/nmt.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "online/identity.hpp"
#include "online/live_bus.hpp"

namespace edsc {

struct ScanSettings {
  std::vector<std::uint8_t> nodes;  ///< ascending, 1..127
  unsigned timeout_ms = 250;        ///< for each response
  unsigned listen_ms = 1200;        ///< minimum; the scan always waits for known heartbeats
};

/// Data read from a node. Nothing if the object does not exist, or if the node does not answer.
struct FoundNode {
  std::uint8_t node_id = 0;
  bool answers_sdo = false;
  bool has_extra_responses = false;        ///< to SDO requests: two nodes may have the node-ID
  std::optional<canopen::NmtState> state;  ///< reported by error control
  Identity identity;
  std::optional<std::uint32_t> heartbeat_ms;  ///< 1017h
  std::optional<std::string> name;            ///< 1008h
};

/// Why a node with `has_extra_responses` is not certain.
[[nodiscard]] std::string extra_responses_text(unsigned node_id);

/// Stores the nodes found, ascending, also before it throws. Throws Interrupted, BusLost.
void scan(LiveBus& bus, const ScanSettings& settings, std::vector<FoundNode>& found);

}  // namespace edsc
