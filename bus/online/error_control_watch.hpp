/// The states that a node reports while a command does something else.
#pragma once

#include <canopen/nmt/error_control.hpp>
#include <cstdint>
#include <functional>
#include <utility>

#include "online/live_bus.hpp"

namespace edsc {

/// During its lifetime, calls `reported` with the state in each heartbeat, boot-up and node guarding message of a node.
class ErrorControlWatch {
 public:
  ErrorControlWatch(LiveBus& bus, std::uint8_t node, std::function<void(canopen::NmtState)> reported) : bus_{bus} {
    bus.on_frame = [node, reported = std::move(reported)](const canopen::Frame& frame, canopen::TimePoint) {
      const auto message = canopen::error_control_message(frame);
      if (message && message->node_id.value() == node) reported(message->state);
    };
  }
  ~ErrorControlWatch() { bus_.on_frame = nullptr; }
  ErrorControlWatch(const ErrorControlWatch&) = delete;
  ErrorControlWatch& operator=(const ErrorControlWatch&) = delete;

 private:
  LiveBus& bus_;
};

}  // namespace edsc
