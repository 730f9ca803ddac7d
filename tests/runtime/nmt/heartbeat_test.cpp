#include <gtest/gtest.h>

#include "support/bench.hpp"

namespace {

using bench::Bench;
namespace od = sample::od;
using namespace std::chrono_literals;

constexpr auto write_100_ms = "605 2B 17 10 00 64 00 00 00";
constexpr auto write_0 = "605 2B 17 10 00 00 00 00 00";

TEST(Heartbeat, IsOffWithAPeriodOfZero) {
  Bench device;
  EXPECT_FALSE(device.node.next_deadline());
  EXPECT_EQ(device.pass(10s), "");
}

TEST(Heartbeat, StartsAtOnceWhenThePeriodIsWritten) {
  Bench device;
  EXPECT_EQ(device.ask(write_100_ms), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(device.node.next_deadline(), device.now + 100ms);
  EXPECT_EQ(device.pass(99ms), "");
  EXPECT_EQ(device.pass(1ms), "705 7F");
  EXPECT_EQ(device.pass(300ms), "705 7F | 705 7F | 705 7F");
}

TEST(Heartbeat, ComesWhenABusWithoutRoomForLongerThanMomentsCompareHasRoomAgain) {
  Bench device;
  device.ask(write_100_ms);
  device.bus.room = 0;
  device.pass(20min);
  device.pass(20min);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s), "705 7F");
  EXPECT_EQ(device.pass(100ms), "705 7F");
}

TEST(Heartbeat, EndsWhenZeroIsWritten) {
  Bench device;
  device.ask(write_100_ms);
  EXPECT_EQ(device.ask(write_0), "585 60 17 10 00 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Heartbeat, StartsWhenTheApplicationSetsThePeriod) {
  Bench device;
  EXPECT_EQ(device.node.set<od::producer_heartbeat_time>(canopen::raw(50)), canopen::ok);
  EXPECT_EQ(device.pass(100ms), "705 7F | 705 7F | 705 7F");
}

TEST(Heartbeat, CarriesTheState) {
  Bench device;
  EXPECT_EQ(device.node.set<od::producer_heartbeat_time>(canopen::raw(100)), canopen::ok);
  device.pass(0ms);
  device.ask(bench::stop);
  EXPECT_EQ(device.pass(100ms), "705 04");
  device.ask(bench::enter_pre_operational);
  EXPECT_EQ(device.pass(100ms), "705 7F");
}

/// The sample device with a default of 1017h other than 0, as a stored value would be.
struct StoredHeartbeat : sample::Device {
  static void reset_communication(Values& values) {
    sample::Device::reset_communication(values);
    values.communication_cleared.producer_heartbeat_time = 20;
  }
};

// shows 000.41, 002.61
TEST(Heartbeat, TheBootUpMessageIsTheFirstOne) {
  bench::RecordingBus bus;
  auto node = bench::make_node<StoredHeartbeat>(bus, canopen::NodeId{5});
  node.start(canopen::TimePoint{3ms});
  EXPECT_EQ(bus.take(), "705 00");
  EXPECT_EQ(node.next_deadline(), canopen::TimePoint{23ms});
  node.on_time(canopen::TimePoint{23ms});
  EXPECT_EQ(bus.take(), "705 7F");
}

TEST(Heartbeat, KeepsItsRasterWhenServedLate) {
  Bench<StoredHeartbeat> device;
  device.node.on_time(canopen::TimePoint{27ms});
  EXPECT_EQ(device.bus.take(), "705 7F");
  EXPECT_EQ(device.node.next_deadline(), canopen::TimePoint{40ms});
}

TEST(Heartbeat, LeavesOutWhatWasMissed) {
  Bench<StoredHeartbeat> device;
  device.node.on_time(canopen::TimePoint{95ms});
  EXPECT_EQ(device.bus.take(), "705 7F");
  EXPECT_EQ(device.node.next_deadline(), canopen::TimePoint{115ms});
}

TEST(Heartbeat, WaitsForRoomOnTheBus) {
  Bench<StoredHeartbeat> device;
  device.bus.room = 0;
  device.node.on_time(canopen::TimePoint{20ms});
  EXPECT_EQ(device.node.next_deadline(), canopen::TimePoint{20ms});
  device.bus.room = 10;
  device.node.on_time(canopen::TimePoint{21ms});
  EXPECT_EQ(device.bus.take(), "705 7F");
  EXPECT_EQ(device.node.next_deadline(), canopen::TimePoint{40ms});
}

TEST(Heartbeat, RunsOnWhenTheTimeWraps) {
  bench::RecordingBus bus;
  auto node = bench::make_node<StoredHeartbeat>(bus, canopen::NodeId{5});
  const canopen::TimePoint almost{canopen::Duration{0xFFFF'F000}};
  node.start(almost);
  bus.take();
  node.on_time(almost + 19ms);
  EXPECT_EQ(bus.take(), "");
  node.on_time(almost + 20ms);
  EXPECT_EQ(bus.take(), "705 7F");
}

}  // namespace
