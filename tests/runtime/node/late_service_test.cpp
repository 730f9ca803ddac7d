/// Nodes that are served later than requested: by minutes, while the bus is full, and by more than the range in which
/// two TimePoints compare.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>

#include "support/bench.hpp"

namespace {

namespace od = pdo_device::od;
using namespace std::chrono_literals;
using Bench = bench::Bench<pdo_device::Device>;

/// An inhibit time, as the bytes of 1800h:03.
constexpr std::uint8_t ten_milliseconds[] = {100, 0};

/// Lets time pass in steps of at most a quarter of an hour while the bus accepts no heartbeat.
void pass_without_room(Bench& device, canopen::Duration span) {
  device.bus.room = 0;
  for (canopen::Duration step{0}; span.count() != 0; span = span - step) {
    step = std::min(span, canopen::Duration{15min});
    device.now = device.now + step;
    device.node.on_time(device.now);
  }
  device.bus.room = 100;
}

std::string serve(Bench& device) {
  device.node.on_time(device.now);
  return device.bus.take();
}

TEST(LateTpdo, GoesOutWhoseEventTimerRanOut40MinutesAgo) {
  Bench device;
  const std::string tpdo = device.ask(bench::start);
  device.ask("605 2B 00 18 05 0A 00 00 00");  // 10 ms
  device.ask("605 2B 17 10 00 0A 00 00 00");
  pass_without_room(device, 40min);
  const auto deadline = device.node.next_deadline();
  ASSERT_TRUE(deadline);
  EXPECT_LE(*deadline, device.now) << "it is due, as is the heartbeat";
  EXPECT_EQ(serve(device), "705 05 | " + tpdo);
  EXPECT_EQ(device.pass(10ms), "705 05 | " + tpdo);
}

TEST(LateTpdo, GoesOutWhoseInhibitTimeEnded40MinutesAgo) {
  Bench device;
  EXPECT_EQ(device.node.set(0x1800, 3, ten_milliseconds), canopen::ok);
  device.ask(bench::start);
  device.ask("605 2B 17 10 00 0A 00 00 00");
  device.node.set<od::input_word>(0x1234);
  pass_without_room(device, 40min);
  const std::string sent = serve(device);
  EXPECT_EQ(sent.substr(0, 12), "705 05 | 185") << sent;
}

TEST(LateHeartbeat, GoesOutOnceAndThenEveryPeriod) {
  Bench device;
  device.ask("605 2B 17 10 00 0A 00 00 00");
  pass_without_room(device, 40min);
  EXPECT_EQ(serve(device), "705 7F");
  EXPECT_EQ(serve(device), "");
  EXPECT_EQ(device.pass(10ms), "705 7F");
}

TEST(LateEmcy, GoesOutWhoseInhibitTimeEnded40MinutesAgo) {
  Bench device;
  EXPECT_EQ(device.node.set<od::inhibit_time_emcy>(canopen::raw(100)), canopen::ok);  // 10 ms
  device.node.emergency(0x1000, canopen::ErrorRegister::generic);
  device.node.emergency(0x2000, canopen::ErrorRegister::generic);
  EXPECT_EQ(serve(device), "085 00 10 01 00 00 00 00 00");
  device.ask("605 2B 17 10 00 0A 00 00 00");
  pass_without_room(device, 40min);
  EXPECT_EQ(serve(device), "705 7F | 085 00 20 01 00 00 00 00 00");
}

TEST(LateRpdo, HasBeenMissedThoughNobodyLooked) {
  std::string log;
  auto device = bench::with<pdo_device::Device>(canopen::on_rpdo([&](canopen::RpdoEvent event, std::uint16_t number) {
    log += "0+-!?"[static_cast<int>(event)] + std::to_string(number) + " ";
  }));
  device.ask("605 2B 00 14 05 0A 00 00 00");  // 10 ms
  device.ask(bench::start);
  device.ask("205 01 00 00 00 00 00");
  device.now = device.now + 15ms;
  EXPECT_EQ(device.ask("205 02 00 00 00 00 00"), "085 50 82 11 00 00 00 00 00 | 085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(log, "01 -1 ?1 01 ");
}

TEST(LateRpdo, HasBeenMissed40MinutesAgo) {
  Bench device;
  device.ask("605 2B 00 14 05 0A 00 00 00");
  device.ask(bench::start);
  device.ask("205 01 00 00 00 00 00");
  device.now = device.now + canopen::Duration{40min};
  EXPECT_EQ(serve(device), "085 50 82 11 00 00 00 00 00");
}

}  // namespace
