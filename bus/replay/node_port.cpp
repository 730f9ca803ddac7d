#include "replay/node_port.hpp"

#include <algorithm>
#include <canopen_sim/simulated_node.hpp>
#include <utility>

#include "device/dynamic_node.hpp"

namespace edsc::replay {

/// A node and its connection.
struct NodePort::Connected final : canopen::SimulatedBus {
  Connected(NodePort& of, std::size_t at, std::uint8_t id, std::shared_ptr<const Sheet> of_node)
      : port{of}, place{at}, node_id{id}, sheet{std::move(of_node)}, memory{canopen::NodeId{id}} {}

  bool send(const canopen::Frame& frame) override {
    port.sent_.push_back({place, frame});
    return true;
  }

  NodePort& port;
  std::size_t place;
  std::uint8_t node_id;
  std::shared_ptr<const Sheet> sheet;
  canopen::SimulatedMemory memory;
  std::unique_ptr<canopen::SimulatedNode> node;  ///< null: switched off
};

NodePort::NodePort() = default;
NodePort::~NodePort() = default;

void NodePort::add(std::uint8_t node_id, std::shared_ptr<const Sheet> sheet) {
  nodes_.push_back(std::make_unique<Connected>(*this, nodes_.size(), node_id, std::move(sheet)));
}

void NodePort::power_on(std::uint8_t node_id) {
  for (const auto& connected : nodes_) {
    if (connected->node_id != node_id) continue;
    connected->node.reset();
    connected->node = make_dynamic_node(connected->sheet, *connected, connected->memory);
    connected->node->start(now_);
  }
}

bool NodePort::send(const canopen::Frame& frame) {
  deliver(frame, std::nullopt);
  return true;
}

std::optional<canopen::Frame> NodePort::receive(canopen::Duration timeout) {
  /// A node that is always due does not stop the time.
  constexpr canopen::Duration smallest_step{100};
  const canopen::TimePoint end = now_ + std::min(timeout, canopen::longest_span);
  for (;;) {
    for (const auto& connected : nodes_) {
      if (connected->node) connected->node->on_time(now_);
    }
    if (!sent_.empty()) {
      const Sent sent = sent_.front();
      sent_.pop_front();
      deliver(sent.frame, sent.from);
      return sent.frame;
    }
    if (now_ >= end) return std::nullopt;
    const canopen::TimePoint next = next_deadline(end);
    now_ = next > now_ ? next : std::min(now_ + smallest_step, end);
  }
}

void NodePort::deliver(const canopen::Frame& frame, std::optional<std::size_t> from) {
  for (const auto& connected : nodes_) {
    if (connected->node && connected->place != from) connected->node->on_frame(frame, now_);
  }
}

canopen::TimePoint NodePort::next_deadline(canopen::TimePoint end) const {
  canopen::TimePoint next = end;
  for (const auto& connected : nodes_) {
    if (!connected->node) continue;
    const std::optional<canopen::TimePoint> due = connected->node->next_deadline();
    if (due && *due < next) next = *due;
  }
  return next;
}

}  // namespace edsc::replay
