/// Nodes in simulated time, each from its EDS: the bus of a replay without a bus.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "device/sheet.hpp"
#include "online/live_bus.hpp"

namespace edsc::replay {

/// Time passes in `receive` only. The nodes receive each other's frames.
class NodePort final : public BusPort {
 public:
  NodePort();
  ~NodePort() override;

  /// Adds a node, which is switched off.
  void add(std::uint8_t node_id, std::shared_ptr<const Sheet> sheet);
  /// Switches a node off, if it is on, and on: it sends its boot-up message. Its stored values remain.
  void power_on(std::uint8_t node_id);

  [[nodiscard]] bool send(const canopen::Frame& frame) override;
  [[nodiscard]] std::optional<canopen::Frame> receive(canopen::Duration timeout) override;
  [[nodiscard]] canopen::TimePoint now() const override { return now_; }
  [[nodiscard]] canopen::TimePoint received_at() const override { return now_; }
  [[nodiscard]] canopen::Duration longest_at_once() const override { return canopen::from_milliseconds(10'000); }

 private:
  struct Connected;
  struct Sent {
    std::size_t from;
    canopen::Frame frame;
  };

  void deliver(const canopen::Frame& frame, std::optional<std::size_t> from);
  /// The earliest deadline of a node, at most `end`.
  [[nodiscard]] canopen::TimePoint next_deadline(canopen::TimePoint end) const;

  std::vector<std::unique_ptr<Connected>> nodes_;
  std::deque<Sent> sent_;
  canopen::TimePoint now_{};
};

}  // namespace edsc::replay
