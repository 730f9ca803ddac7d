/// Heartbeat and node guarding of a node, and how a master monitors it.
#pragma once

#include <cstdint>
#include <optional>

#include "device/device.hpp"

namespace edsc {

/// 100Ch and 100Dh (CiA 301, 7.5.2.11 and 7.5.2.12).
struct NodeGuarding {
  std::uint16_t guard_time = 0;  ///< in ms
  std::uint8_t life_time_factor = 0;
};

/// 1017h in ms; 0 if the device does not produce a heartbeat.
[[nodiscard]] std::uint64_t heartbeat_time(const Device& device);

/// Nothing if the device does not have both values, or one is 0. A device that also has a heartbeat is not guarded
/// (CiA 301, 7.2.8.2.2).
[[nodiscard]] std::optional<NodeGuarding> node_guarding(const Device& device);

/// 1F81h of the master for a slave that it boots, with the guarding times of a slave without a heartbeat (CiA 302-2).
[[nodiscard]] std::uint32_t slave_assignment(const Device& slave);

}  // namespace edsc
