/// A heartbeat producer that the test simulates, and the entry of 1016h that monitors it.
#pragma once

#include <fmt/format.h>

#include <canopen/can/node_id.hpp>
#include <cstdint>
#include <optional>

#include "conform/cases/nmt/error_control.hpp"

namespace edsc::conform {

/// A node with a free node-ID. Not applicable if the EDS does not have a writable 1016h:01 for each node-ID.
class HeartbeatSource {
 public:
  explicit HeartbeatSource(Dut& dut) : dut_{dut} {
    const std::optional<Value>& limit = dut.need_writable(consumer_heartbeat, 1).high_limit;
    node_ = free_node_id(dut);
    if (limit && limit->bits < value(milliseconds{0xFFFF})) {
      dut.not_applicable(fmt::format("the EDS limits 1016h:01 to {:X}h, which is too low for a node-ID", limit->bits));
    }
  }

  void watch(Duration time, std::uint8_t sub_index = 1) const {
    dut_.write(consumer_heartbeat, sub_index, value(time));
  }

  void unwatch(std::uint8_t sub_index = 1) const { dut_.write(consumer_heartbeat, sub_index, 0); }

  /// The value of 1016h for this node.
  [[nodiscard]] std::uint64_t value(Duration time) const {
    return std::uint64_t{node_.value()} << 16 | time.count() / 1000;
  }

  /// Sends one heartbeat and returns the time.
  std::uint64_t beat(NmtState state = NmtState::operational) const {
    dut_.send(0x700U + node_.value(), Bytes{static_cast<std::uint8_t>(state)});
    return dut_.now();
  }

  /// Sends `count` heartbeats with this period and returns the time of the last one.
  std::uint64_t beats(Duration period, unsigned count) const {
    std::uint64_t last = beat();
    for (unsigned i = 1; i < count; ++i) {
      dut_.pass_time(period);
      last = beat();
    }
    return last;
  }

 private:
  Dut& dut_;
  canopen::NodeId node_;
};

}  // namespace edsc::conform
