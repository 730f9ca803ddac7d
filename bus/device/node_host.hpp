/// Several nodes on one connection to a bus. They receive each other's frames, as nodes with connections of their own
/// do.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen_sim/simulated_node.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "online/live_bus.hpp"

namespace edsc {

class NodeHost {
 public:
  /// The bus must outlive the host.
  explicit NodeHost(LiveBus& bus);
  NodeHost(const NodeHost&) = delete;
  NodeHost& operator=(const NodeHost&) = delete;
  ~NodeHost();

  /// Makes a node, which sends through the bus and keeps its node-ID in the memory; both outlive it.
  using MakeNode =
      std::function<std::unique_ptr<canopen::SimulatedNode>(canopen::SimulatedBus&, canopen::SimulatedMemory&)>;

  /// Adds a node that is off, and returns its place.
  std::size_t add(canopen::NodeId node_id, const MakeNode& make);

  /// Switches all nodes on: they send their boot-up messages.
  void start();
  void switch_on(std::size_t place);
  /// A node that is off neither sends nor receives. It keeps what it has stored, and starts again when it is switched
  /// on.
  void switch_off(std::size_t place);

  /// Serves the nodes until there is an Interruption, or `turn` returns false, which is called after each frame, and at
  /// least as often as `pause` returns. Throws BusLost.
  void run(const std::function<bool()>& turn, const std::function<canopen::Duration()>& pause);

  /// Called with each frame of the bus and of the nodes.
  std::function<void(const canopen::Frame&)> on_frame;

 private:
  struct Connected;
  struct Sent {
    std::size_t from;
    canopen::Frame frame;
  };

  /// Passes the frames that nodes have sent to the other nodes.
  void deliver();
  /// Returns how long no node has anything to do, `longest` at most.
  [[nodiscard]] canopen::Duration idle_time(canopen::Duration longest) const;

  LiveBus& bus_;
  std::vector<std::unique_ptr<Connected>> nodes_;
  std::deque<Sent> sent_;
};

}  // namespace edsc
