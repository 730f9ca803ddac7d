#include "device/node_host.hpp"

#include <algorithm>
#include <canopen_sim/simulated_node.hpp>
#include <optional>

#include "online/interruption.hpp"

namespace edsc {
namespace {

/// How often a bus without room is tried again.
constexpr canopen::Duration try_again{1'000};

}  // namespace

/// A node and its connection.
struct NodeHost::Connected final : canopen::SimulatedBus {
  Connected(NodeHost& of, std::size_t at, canopen::NodeId node_id) : host{of}, place{at}, memory{node_id} {}

  bool send(const canopen::Frame& frame) override {
    full = !host.bus_.send(frame);
    if (full) return false;
    host.sent_.push_back({place, frame});
    if (host.on_frame) host.on_frame(frame);
    return true;
  }

  NodeHost& host;
  std::size_t place;
  canopen::SimulatedMemory memory;
  std::unique_ptr<canopen::SimulatedNode> node;
  bool is_on = false;
  bool full = false;  ///< the bus had no room for the last frame
};

NodeHost::NodeHost(LiveBus& bus) : bus_{bus} {}
NodeHost::~NodeHost() = default;

std::size_t NodeHost::add(canopen::NodeId node_id, const MakeNode& make) {
  Connected& added = *nodes_.emplace_back(std::make_unique<Connected>(*this, nodes_.size(), node_id));
  added.node = make(added, added.memory);
  return added.place;
}

void NodeHost::start() {
  for (const auto& connected : nodes_) switch_on(connected->place);
}

void NodeHost::switch_on(std::size_t place) {
  Connected& connected = *nodes_[place];
  connected.is_on = true;
  connected.full = false;
  connected.node->start(bus_.now());
  deliver();
}

void NodeHost::switch_off(std::size_t place) { nodes_[place]->is_on = false; }

void NodeHost::run(const std::function<bool()>& turn, const std::function<canopen::Duration()>& pause) {
  while (!Interruption::noted() && turn()) {
    const std::optional<canopen::Frame> frame = bus_.receive(idle_time(pause()));
    if (frame && on_frame) on_frame(*frame);
    for (const auto& connected : nodes_) {
      if (!connected->is_on) continue;
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
      if (connected->is_on && connected->place != sent.from) connected->node->on_frame(sent.frame, bus_.now());
    }
  }
}

canopen::Duration NodeHost::idle_time(canopen::Duration longest) const {
  if (!sent_.empty()) return canopen::Duration{0};
  const canopen::TimePoint now = bus_.now();
  canopen::Duration wait = longest;
  for (const auto& connected : nodes_) {
    if (!connected->is_on) continue;
    const std::optional<canopen::TimePoint> due = connected->node->next_deadline();
    if (!due) continue;
    const canopen::Duration own = now < *due ? *due - now : canopen::Duration{0};
    wait = std::min(wait, connected->full ? std::max(own, try_again) : own);
  }
  return wait;
}

}  // namespace edsc
