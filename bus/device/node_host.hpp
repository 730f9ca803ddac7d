/// Several nodes on one connection to a bus. They receive each other's frames, as nodes with connections of their own
/// do.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/sheet.hpp"
#include "online/live_bus.hpp"

namespace edsc {

class NodeHost {
 public:
  /// The bus must outlive the host.
  explicit NodeHost(LiveBus& bus);
  NodeHost(const NodeHost&) = delete;
  NodeHost& operator=(const NodeHost&) = delete;
  ~NodeHost();

  /// Adds a node that is off, and returns its place. `memory`: the file of its stored values; empty: they are lost at
  /// the end of the program.
  std::size_t add(std::shared_ptr<const Sheet> sheet, canopen::NodeId node_id, const std::string& memory);

  /// Switches all nodes on: they send their boot-up messages.
  void start();
  void switch_on(std::size_t place);
  /// A node that is off neither sends nor receives. It keeps what it has stored.
  void switch_off(std::size_t place);

  /// Serves the nodes until there is an Interruption. `each_turn` is called at least every 100 ms. Throws BusLost.
  void run(const std::function<void()>& each_turn = [] {});

 private:
  struct Connected;
  struct Sent {
    std::size_t from;
    canopen::Frame frame;
  };

  /// Passes the frames that nodes have sent to the other nodes.
  void deliver();
  /// Returns how long no node has anything to do.
  [[nodiscard]] canopen::Duration idle_time() const;

  LiveBus& bus_;
  std::vector<std::unique_ptr<Connected>> nodes_;
  std::deque<Sent> sent_;
};

}  // namespace edsc
