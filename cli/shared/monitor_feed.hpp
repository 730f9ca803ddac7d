/// The state of a bus for the monitor, from its frames.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>

#include "decode/decoder.hpp"
#include "monitor/monitor_state.hpp"
#include "online/elapsed_time.hpp"
#include "shared/given_nodes.hpp"

namespace edsc {

class MonitorFeed {
 public:
  /// The nodes have the names of their EDS files, or those of the network file. `nodes` must outlive the feed.
  MonitorFeed(const GivenNodes& nodes, canopen::TimePoint now);

  /// Returns the message of a frame if it has new information, otherwise null. It is valid until the next call.
  const Message* add(const canopen::Frame& frame, canopen::TimePoint now);
  /// Call regularly.
  void pass(canopen::TimePoint now);

  [[nodiscard]] MonitorState& state() { return state_; }
  [[nodiscard]] const MonitorState& state() const { return state_; }
  /// The time since the start.
  [[nodiscard]] std::int64_t now_us() const { return elapsed_.us(); }

 private:
  Decoder decoder_;
  MonitorState state_;
  Message message_;
  ElapsedTime elapsed_;
};

}  // namespace edsc
