/// A simulated network as text, and as JSON (docs/schema/network_simulate.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "network/network.hpp"
#include "network/timing/timing.hpp"
#include "simulate/simulation_fault.hpp"
#include "simulate/simulation_result.hpp"

namespace edsc {

struct SimulatedNetwork {
  const Network& network;
  const NetworkTiming& timing;
  const std::vector<SimulationFault>& faults;
  const SimulationResult& result;
};

/// What is not as the network file promises, a line for each: an entry that a node rejects, a response time above its
/// bound, values that were not sent, a node that is not Operational at the end. With a fault, response times and lost
/// values do not count, except that error frames are in the bounds; nor do the nodes that lost a heartbeat.
[[nodiscard]] std::vector<std::string> simulation_problems(const SimulatedNetwork& simulated);

/// Load, a table of frames, what the nodes have noticed, and the states of the nodes.
[[nodiscard]] std::vector<std::string> simulation_lines(const SimulatedNetwork& simulated);

[[nodiscard]] nlohmann::ordered_json simulation_json(const SimulatedNetwork& simulated);

}  // namespace edsc
