/// The application of a node of a simulated network: it passes on the events of its heartbeat consumer. Host side.
#pragma once

#include <memory>
#include <tuple>

#include "canopen_sim/simulated_node.hpp"

namespace canopen::network_simulation {

/// Gets the events of the node that is being served.
class HeartbeatListener {
 public:
  virtual void on_heartbeat(HeartbeatEvent event, NodeId other) = 0;

  static inline HeartbeatListener* served = nullptr;

 protected:
  ~HeartbeatListener() = default;
};

template <class Device>
struct HeartbeatWatch {
  auto handlers() {
    if constexpr (Device::dictionary.has(0x1016, 0)) {
      return std::tuple{canopen::on_heartbeat([](HeartbeatEvent event, NodeId other, NmtState) {
        if (HeartbeatListener::served != nullptr) HeartbeatListener::served->on_heartbeat(event, other);
      })};
    } else {
      return std::tuple<>{};
    }
  }
};

/// Makes a node of a device that edsc has generated, for a PlannedNode.
template <class Device>
[[nodiscard]] std::unique_ptr<SimulatedNode> make_node_of(SimulatedBus& bus, SimulatedMemory& memory) {
  return make_simulated_node<Device, HeartbeatWatch<Device>>(bus, memory);
}

}  // namespace canopen::network_simulation
