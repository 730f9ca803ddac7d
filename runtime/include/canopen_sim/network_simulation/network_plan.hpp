/// What a simulated network consists of; `edsc network simulate` writes it as C++. Host side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "canopen_sim/simulated_node.hpp"

namespace canopen::network_simulation {

/// An object to which the simulation gives new values.
struct PlannedObject {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint8_t bytes;   ///< 1..8
  std::uint64_t low;    ///< the values are low, low + 1, ..., low + range, modulo 2^64
  std::uint64_t range;  ///< at least 1
};

/// Objects that a TPDO maps. They change together.
struct PlannedChange {
  std::size_t message;     ///< of NetworkPlan::messages
  std::uint64_t interval;  ///< in us; the shortest one
  bool is_expected;        ///< a node expects the TPDO because of the change
  bool varies;             ///< the interval is up to an eighth longer
  std::span<const PlannedObject> objects;
};

struct PlannedNode {
  std::string_view name;
  std::uint8_t node_id;
  MakeSimulatedNode make;
  std::span<const std::uint8_t> dcf;  ///< concise DCF
  std::uint32_t emcy_can_id;          ///< 11 bits; 0 if it does not produce EMCY
  std::uint32_t babbling_can_id;      ///< 11 bits; sent without a pause by a babbling node
  std::span<const PlannedChange> changes;
};

/// A message whose response times are compared with a bound.
struct PlannedMessage {
  std::uint32_t can_id;
  bool extended;
  bool remote;
  bool is_synchronous;  ///< the response time counts from the moment when SYNC was queued
};

struct NetworkPlan {
  std::uint32_t bit_rate;      ///< bit/s
  std::uint64_t sdo_interval;  ///< of SDO requests to one node after the other, in us
  std::uint32_t sync_can_id;
  std::size_t master;  ///< sends these requests; the number of nodes if the network does not have a master
  std::span<const PlannedNode> nodes;
  std::span<const PlannedMessage> messages;
};

}  // namespace canopen::network_simulation
