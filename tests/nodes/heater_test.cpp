/// The device of docs/comparison.md by its frames: each service that the page counts.
#include "heater/heater.hpp"

#include <gtest/gtest.h>

#include "support/bench.hpp"

namespace {

using namespace std::chrono_literals;

struct HeaterTest : testing::Test {
  HeaterTest() {
    hardware = {};
    node.start(now);
    EXPECT_EQ(bus.take(), "705 00");
    EXPECT_EQ(ask("000 01 05"), "185 00");
  }
  std::string ask(const char* request) {
    node.on_frame(bench::frame(request), now);
    return bus.take();
  }
  std::string pass(canopen::Duration span) {
    now = now + span;
    node.on_time(now);
    return bus.take();
  }

  bench::RecordingBus bus;
  canopen::TimePoint now{};
  canopen::Node<heater::Device, bench::RecordingBus, Heater> node{bus, canopen::NodeId{5}};
};

TEST_F(HeaterTest, AWrittenSetpointSendsThePowerOnce) {
  EXPECT_EQ(ask("605 2B 00 20 00 F4 01 00 00"), "585 60 00 20 00 00 00 00 00 | 185 32");
  EXPECT_EQ(ask("205 F5 01"), "");  // the same power
  EXPECT_EQ(ask("205 58 02"), "185 3C");
}

TEST_F(HeaterTest, RefusesASetpointWhileTheDoorIsOpen) {
  hardware.door_open = true;
  EXPECT_EQ(ask("605 2B 00 20 00 F4 01 00 00"), "585 80 00 20 00 22 00 00 08");
  EXPECT_EQ(ask("605 40 00 20 00 00 00 00 00"), "585 4B 00 20 00 00 00 00 00");
}

TEST_F(HeaterTest, ReadsTheSensorOnEachUpload) {
  hardware.sensor = -0.5_degC;
  EXPECT_EQ(ask("605 40 02 20 00 00 00 00 00"), "585 4B 02 20 00 FB FF 00 00");
  hardware.sensor = 30_degC;
  EXPECT_EQ(ask("605 40 02 20 00 00 00 00 00"), "585 4B 02 20 00 2C 01 00 00");
}

TEST_F(HeaterTest, ReportsAHighSetpointByEmcy) {
  const std::string sent = ask("205 B6 03");
  EXPECT_NE(sent.find("085 00 42 09 00 00 00 00 00"), std::string::npos) << sent;
  EXPECT_NE(sent.find("185 5F"), std::string::npos) << sent;
}

TEST_F(HeaterTest, ProducesItsHeartbeat) {
  EXPECT_EQ(pass(1s), "705 05");
  EXPECT_EQ(pass(1s), "705 05");
}

}  // namespace
