#include "device/node_host.hpp"

#include <algorithm>
#include <canopen/host/simulated_node.hpp>
#include <optional>
#include <utility>

#include "device/dynamic_node.hpp"
#include "online/interruption.hpp"

namespace edsc {
namespace {

/// How often an interruption is checked, and a bus without room is tried again.
constexpr canopen::Duration longest_wait{100'000}, try_again{1'000};

}  // namespace

/// A node and its connection.
struct NodeHost::Connected final : canopen::SimulatedBus {
  Connected(NodeHost& of, std::size_t at, std::shared_ptr<const Sheet> of_node, canopen::NodeId node_id,
            std::string of_memory)
      : host{of}, place{at}, sheet{std::move(of_node)}, file{std::move(of_memory)}, memory{node_id} {}

  bool send(const canopen::Frame& frame) override {
    full = !host.bus_.send(frame);
    if (full) return false;
    host.sent_.push_back({place, frame});
    return true;
  }

  NodeHost& host;
  std::size_t place;
  std::shared_ptr<const Sheet> sheet;
  std::string file;
  canopen::SimulatedMemory memory;
  std::unique_ptr<canopen::SimulatedNode> node;  ///< null: it is off
  bool full = false;                             ///< the bus had no room for the last frame
};

NodeHost::NodeHost(LiveBus& bus) : bus_{bus} {}
NodeHost::~NodeHost() = default;

std::size_t NodeHost::add(std::shared_ptr<const Sheet> sheet, canopen::NodeId node_id, const std::string& memory) {
  const std::size_t place = nodes_.size();
  nodes_.push_back(std::make_unique<Connected>(*this, place, std::move(sheet), node_id, memory));
  return place;
}

void NodeHost::start() {
  for (const auto& connected : nodes_) switch_on(connected->place);
}

void NodeHost::switch_on(std::size_t place) {
  Connected& connected = *nodes_[place];
  connected.node = make_dynamic_node(connected.sheet, connected, connected.memory, connected.file);
  connected.full = false;
  connected.node->start(bus_.now());
  deliver();
}

void NodeHost::switch_off(std::size_t place) { nodes_[place]->node.reset(); }

void NodeHost::run(const std::function<void()>& each_turn) {
  while (!Interruption::noted()) {
    const std::optional<canopen::Frame> frame = bus_.receive(idle_time());
    each_turn();
    for (const auto& connected : nodes_) {
      if (!connected->node) continue;
      if (frame) connected->node->on_frame(*frame, bus_.now());
      connected->node->on_time(bus_.now());
    }
    deliver();
  }
}

/// What nodes send in response waits for the next turn: nodes that respond to each other endlessly do not stop the
/// others.
void NodeHost::deliver() {
  for (std::size_t left = sent_.size(); left > 0; --left) {
    const Sent sent = sent_.front();
    sent_.pop_front();
    for (const auto& connected : nodes_) {
      if (connected->node && connected->place != sent.from) connected->node->on_frame(sent.frame, bus_.now());
    }
  }
}

canopen::Duration NodeHost::idle_time() const {
  if (!sent_.empty()) return canopen::Duration{0};
  const canopen::TimePoint now = bus_.now();
  canopen::Duration wait = longest_wait;
  for (const auto& connected : nodes_) {
    if (!connected->node) continue;
    const std::optional<canopen::TimePoint> due = connected->node->next_deadline();
    if (!due) continue;
    const canopen::Duration own = now < *due ? *due - now : canopen::Duration{0};
    wait = std::min(wait, connected->full ? std::max(own, try_again) : own);
  }
  return wait;
}

}  // namespace edsc
