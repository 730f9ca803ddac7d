/// A bus that is flooded for a minute with frames that are not responses.
#pragma once

#include <gtest/gtest.h>

#include <canopen/base/abort_code.hpp>
#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>
#include <chrono>
#include <optional>

#include "support/bench.hpp"

namespace bench {

struct FloodedBus {
  canopen::TimePoint time{};
  unsigned requests = 0;  ///< SDO requests to node 5

  bool send(const canopen::Frame& frame) {
    if (frame.id == 0x605) ++requests;
    return true;
  }
  std::optional<canopen::Frame> receive(canopen::Duration timeout) {
    constexpr canopen::Duration between_frames{100};
    const bool is_silent = time - canopen::TimePoint{} > std::chrono::minutes{1};
    time = time + (is_silent ? timeout : between_frames);
    if (is_silent) return std::nullopt;
    return frame("185 01 02");
  }
  [[nodiscard]] canopen::TimePoint now() const { return time; }
};

/// `Sdo` is a BlockingSdo or Master on a FloodedBus.
template <class Sdo>
void expect_timeout_on_a_flooded_bus() {
  FloodedBus bus;
  Sdo sdo{bus};
  EXPECT_EQ(sdo.upload(canopen::NodeId{5}, 0x1000, 0).abort_code(), canopen::AbortCode::timeout);
  EXPECT_EQ(bus.requests, 2u) << "the request and the abort";
  EXPECT_LT(bus.time - canopen::TimePoint{}, std::chrono::seconds{10});
}

}  // namespace bench
