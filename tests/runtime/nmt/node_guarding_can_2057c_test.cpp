/// Manual 003, 5.4.2: the examples of node guarding and heartbeat.
#include <gtest/gtest.h>
#include <canopen/nmt/node_guarding.hpp>

#include <can_2057c/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

using bench::frame;
using canopen::NodeGuardingSlave;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

namespace od = can_2057c::od;

/// The I/O module CAN-2057C with node-ID 1: the node and a separate guarding slave. 07h is the module's own code of the
/// error (manual 003, 5.3.2).
struct Module {
  Module() {
    node.start(now);
    bus.take();
  }

  std::string send(const std::string& text) {
    const canopen::Frame request = frame(text);
    if (!canopen::is_guarding_request(request, NodeId{1})) {
      node.on_frame(request, now);
    } else if (node.get<od::producer_heartbeat_time>().raw() == 0) {
      guarding.on_request(node.get<od::guard_time>().raw(), node.get<od::life_time_factor>(), now);
      EXPECT_TRUE(guarding.serve(bus, NodeId{1}, node.state()));
    }
    return bus.take();
  }

  std::string pass(canopen::Duration span) {
    const TimePoint end = now + span;
    for (;;) {
      const auto guard = guarding.next_deadline();
      const auto beat = node.next_deadline();
      const auto next = guard && (!beat || *guard < *beat) ? guard : beat;
      if (!next || *next > end) break;
      now = *next;
      if (guarding.on_time(node.get<od::guard_time>().raw(), now)) {
        node.emergency(0x8130, canopen::ErrorRegister::communication, {0x07});
      }
      node.on_time(now);
    }
    now = end;
    return bus.take();
  }

  bench::RecordingBus bus;
  TimePoint now{};
  bench::NodeOf<can_2057c::Device, bench::RecordingBus> node{bus, NodeId{1}};
  NodeGuardingSlave guarding;
};

struct ManualStep {
  int line;  ///< of the manual's text
  const char* request;
  canopen::Duration pass;
  const char* answer;
};

void follow(std::initializer_list<ManualStep> steps) {
  Module module;
  for (const ManualStep& step : steps) {
    std::string answer = step.request != nullptr ? module.send(step.request) : std::string{};
    if (step.request == nullptr) answer = module.pass(step.pass);
    EXPECT_EQ(answer, step.answer) << "manual 003, line " << step.line;
  }
}

TEST(NodeGuarding, FollowsTheExampleOfManual003) {
  follow({
      {2384, "601 2B 0C 10 00 FA 00 00 00", 0ms, "581 60 0C 10 00 00 00 00 00"},  // step 2: guard time 250 ms, step 3
      {2409, "601 2F 0D 10 00 04 00 00 00", 0ms, "581 60 0D 10 00 00 00 00 00"},  // step 4: life time factor 4
      {2442, "701 R 0", 0ms, "701 7F"},                                           // step 5: guarding begins, 2456
      {2475, nullptr, 999ms, ""},                                                 // step 6: life time 1000 ms
      {2475, "701 R 0", 0ms, "701 FF"},
      {2477, nullptr, 999ms, ""},
      {2477, nullptr, 1ms, "081 30 81 11 07 00 00 00 00"},  // step 7: the EMCY of life guarding
  });
}

TEST(NodeGuarding, GivesWayToTheHeartbeatAsManual003Shows) {
  follow({
      {2517, "601 2B 17 10 00 FA 00 00 00", 0ms, "581 60 17 10 00 00 00 00 00 | 701 7F"},  // steps 2, 3: 250 ms, 2552
      {2552, nullptr, 500ms, "701 7F | 701 7F"},                                           // step 5
      {2374, "701 R 0", 0ms, ""},  // note: guarding and heartbeat are not used at the same time
      {2550, "601 2B 17 10 00 F4 01 00 00", 0ms, "581 60 17 10 00 00 00 00 00 | 701 7F"},  // the time may change
      {2550, nullptr, 1s, "701 7F | 701 7F"},
  });
}

}  // namespace
