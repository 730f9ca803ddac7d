/// `on_time` returns at once while nothing is due: a node that is polled sends the same frames at the same times as one
/// that is only called when something is due, or after the application has changed something.
#include <gtest/gtest.h>

#include <array>
#include <every_service/device.hpp>
#include <pdo_device/device.hpp>
#include <random>
#include <string>

#include "support/bench.hpp"

namespace {

using namespace std::chrono_literals;
using Bench = bench::Bench<every_service::Device>;

/// Requests that start, change and stop what the node does by time. The times are short, so that they meet.
constexpr std::array requests = {
    "000 01 05",                    // start
    "000 01 05",                    //
    "000 01 05",                    //
    "000 80 05",                    // enter Pre-operational
    "000 02 05",                    // stop
    "000 82 05",                    // reset communication
    "080",                          // SYNC
    "100 00 00 00 00 01 00",        // TIME
    "205 01 02 03 04 05 06 07 08",  // RPDOs
    "305 01 02 03 04 05 06 07 08",  //
    "305 01",                       // too short
    "702 05",                       // heartbeat of node 2
    "705 R 1",                      // guarding request
    "185 R 8",                      // TPDO1
    "605 2B 17 10 00 07 00 00 00",  // heartbeat every 7 ms
    "605 2B 17 10 00 00 00 00 00",  // none
    "605 23 16 10 01 0B 00 02 00",  // consumer heartbeat time of node 2: 11 ms
    "605 2B 0C 10 00 05 00 00 00",  // guard time
    "605 2F 0D 10 00 03 00 00 00",  // life time factor
    "605 23 06 10 00 B8 0B 00 00",  // a SYNC every 3 ms
    "605 23 05 10 00 80 00 00 40",  // produced by this node
    "605 23 05 10 00 80 00 00 00",  // not
    "605 23 07 10 00 D0 07 00 00",  // synchronous window of 2 ms
    "605 2B 15 10 00 32 00 00 00",  // inhibit time of EMCY: 5 ms
    "605 2B 00 14 05 09 00 00 00",  // RPDO1 is monitored for 9 ms
    "605 2B 00 18 05 06 00 00 00",  // event timer of TPDO1: 6 ms
    "605 2B 01 18 05 04 00 00 00",  // of TPDO2: 4 ms
    "605 21 06 20 00 08 00 00 00",  // a segmented download without its segments
    "605 2F 00 20 00 11 00 00 00",  // 2000h
    "605 2F 00 20 00 12 00 00 00",  //
};

struct Polled : Bench {
  void tick(bool) { node.on_time(now); }
};
struct CalledWhenDue : Bench {
  void tick(bool changed) {
    const auto deadline = node.next_deadline();
    if (changed || (deadline && *deadline <= now)) node.on_time(now);
  }
};

TEST(IdleTime, OfAPolledNodeEndsWhenSomethingIsDue) {
  Polled polled;
  CalledWhenDue called;
  const auto both = [&](auto&& action) {
    action(polled);
    action(called);
  };
  std::mt19937 random{20261123};
  std::size_t frames = 0;
  for (int tick = 0; tick < 200'000; ++tick) {
    both([](auto& device) { device.now = device.now + 1ms; });
    if (random() % 4 == 0) {
      const auto request = bench::frame(requests.at(random() % requests.size()));
      both([&](auto& device) { device.node.on_frame(request, device.now); });
    }
    const auto value = static_cast<std::uint8_t>(random());
    const auto action = random() % 64;
    switch (action) {
      case 0: both([&](auto& device) { EXPECT_EQ(device.node.set(0x2000, 0, std::array{value}), canopen::ok); }); break;
      case 1: both([&](auto& device) { device.node.template set<every_service::od::byte>(value); }); break;
      case 2: both([](auto& device) { device.node.emergency(0x8400, canopen::ErrorRegister::generic); }); break;
      case 3: both([](auto& device) { device.node.emergency_over(canopen::ErrorRegister::generic); }); break;
      case 4: both([](auto& device) { device.bus.room = 0; }); break;
      case 5: both([](auto& device) { device.node.request(canopen::NmtCommand::start, device.now); }); break;
      default: both([](auto& device) { device.bus.room = 1000; }); break;
    }
    both([action](auto& device) { device.tick(action < 4); });
    frames += polled.bus.sent.size();
    const std::string sent = polled.bus.take();
    ASSERT_EQ(sent, called.bus.take()) << "tick " << tick;
    ASSERT_EQ(polled.node.state(), called.node.state()) << "tick " << tick;
  }
  EXPECT_GT(frames, 50'000u);
}

/// Time wraps after 71 minutes: an inhibit time that has elapsed must be noticed before that.
TEST(IdleTime, DoesNotLastUntilTimeWraps) {
  bench::Bench<pdo_device::Device> device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 2B 00 18 03 FF FF 00 00");  // inhibit time of 6.5535 s
  device.ask("605 23 00 18 01 85 01 00 40");
  EXPECT_EQ(device.ask(bench::start), "185 00 00 00 00 00 00");
  device.pass(1s);
  device.pass(0s);  // twice without an event
  for (int half_hours = 0; half_hours < 2; ++half_hours) device.pass(30min);
  device.pass(11min + 36s);  // 71 minutes and 37 seconds after the TPDO: 2 seconds after the wrap
  device.node.set<pdo_device::od::input_word>(7);
  EXPECT_EQ(device.pass(0s), "185 07 00 00 00 00 00");
}

canopen::TimePoint at(std::uint32_t microseconds) { return canopen::TimePoint{canopen::Duration{microseconds}}; }

TEST(TimeSlots, AreCheckedOnceEach) {
  canopen::node_detail::TimeSlots slots;
  EXPECT_FALSE(slots.lasts(at(200)));
  EXPECT_TRUE(slots.lasts(at(200)));
  EXPECT_TRUE(slots.lasts(at(255)));
  EXPECT_FALSE(slots.lasts(at(256)));
  EXPECT_TRUE(slots.lasts(at(256)));
  EXPECT_FALSE(slots.lasts(at(100))) << "the clock has overflowed";
}

/// A timer of 16 bits that overflows is a usual time to call a node.
TEST(TimeSlots, AreCheckedByCallsWithAnyPeriodUpToSeconds) {
  for (const std::uint32_t period : {128u, 1'000u, 31'250u, 32'768u, 65'536u, 1'000'000u, 1'048'576u, 4'194'304u}) {
    canopen::node_detail::TimeSlots slots;
    for (std::uint32_t call = 1; call <= 1000; ++call) EXPECT_FALSE(slots.lasts(at(call * period))) << period;
  }
}

}  // namespace
