/// A participant of a VirtualBus that waits for frames, while time passes on the bus. Host side.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen_sim/virtual_bus.hpp"

namespace canopen {

/// Port on a VirtualBus. It must live as long as the bus.
class VirtualBusPort {
 public:
  explicit VirtualBusPort(VirtualBus& bus) : bus_{bus}, endpoint_{bus.attach()} {
    endpoint_.on_frame = [this](const Frame& frame, TimePoint) { received_.push_back(frame); };
  }
  VirtualBusPort(const VirtualBusPort&) = delete;
  VirtualBusPort& operator=(const VirtualBusPort&) = delete;

  [[nodiscard]] bool send(const Frame& frame) { return endpoint_.send(frame); }

  /// Returns the next frame; empty if none is received within this time.
  [[nodiscard]] std::optional<Frame> receive(Duration timeout) {
    constexpr Duration step{100};
    const TimePoint end = bus_.now() + timeout;
    while (received_.empty() && bus_.now() < end) {
      if (bus_.settle(1) == 0) bus_.run_for(std::min(step, end - bus_.now()));
    }
    if (received_.empty()) return std::nullopt;
    const Frame frame = received_.front();
    received_.pop_front();
    return frame;
  }

  [[nodiscard]] TimePoint now() const { return bus_.now(); }

 private:
  VirtualBus& bus_;
  VirtualBus::Endpoint& endpoint_;
  std::deque<Frame> received_;
};

}  // namespace canopen
