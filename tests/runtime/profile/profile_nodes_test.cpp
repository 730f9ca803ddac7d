/// The profiles as whole nodes: what the bus sees of terminals, a sensor and a motor that the application writes.
#include <gtest/gtest.h>

#include <array>
#include <canopen/profile/cia401_node.hpp>
#include <canopen/profile/cia406_node.hpp>
#include <cstdint>
#include <encoder/device.hpp>
#include <io_device/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

using bench::RecordingBus;
using canopen::NodeId;
using namespace std::chrono_literals;

template <class Device>
struct NodeOnBus {
  NodeOnBus() {
    device.start(now);
    ask(bench::start);
  }
  std::string ask(const std::string& request) {
    device.on_frame(bench::frame(request), now);
    return bus.take();
  }
  std::string pass(canopen::Duration span) {
    now = now + span;
    device.on_time(now);
    return bus.take();
  }
  RecordingBus bus;
  canopen::TimePoint now{};
  Device device{bus, NodeId{5}};
};

struct Terminals {
  std::uint8_t digital(std::uint8_t block) { return inputs[block]; }
  void set_digital(std::uint8_t block, std::uint8_t levels) { outputs[block] = levels; }
  std::int16_t analogue(std::uint8_t) { return 0; }
  void set_analogue(std::uint8_t, std::int16_t) {}

  std::array<std::uint8_t, 2> inputs{};
  std::array<std::uint8_t, 2> outputs{};
};

struct ModuleNode : testing::Test,
                    NodeOnBus<canopen::cia401::ModuleNode<io_device::Device, RecordingBus, Terminals>> {};

TEST_F(ModuleNode, SendsItsInputsAtAChange) {
  pass(1s);
  device.terminals().inputs = {0x55, 0x80};
  EXPECT_EQ(pass(1ms), "185 55 80");
  EXPECT_EQ(pass(1ms), "");
}

TEST_F(ModuleNode, SetsItsOutputsWithTheRpdo) {
  ask("205 34 12");
  EXPECT_EQ(device.terminals().outputs, (std::array<std::uint8_t, 2>{0x34, 0x12}));
}

TEST_F(ModuleNode, SetsTheErrorValuesWhenItIsStopped) {
  ask("605 2F 07 62 01 0F 00 00 00");  // error value of block 1
  ask("205 34 12");
  ask(bench::stop);
  EXPECT_EQ(device.terminals().outputs, (std::array<std::uint8_t, 2>{0x0F, 0x00}));
}

TEST_F(ModuleNode, SetsTheErrorValuesAtBusOff) {
  ask("205 34 12");
  device.on_bus_status({.state = canopen::BusState::off}, now);
  EXPECT_EQ(device.terminals().outputs, (std::array<std::uint8_t, 2>{0x00, 0x00}));
}

struct Sensor {
  std::int32_t position() const { return steps; }
  std::int16_t speed() const { return -2; }
  std::int32_t steps = 1'000;
};

struct EncoderNode : testing::Test, NodeOnBus<canopen::cia406::EncoderNode<encoder::Device, RecordingBus, Sensor>> {};

TEST_F(EncoderNode, SendsPositionAndSpeed) {
  pass(1ms);
  device.sensor().steps = 2'000;
  EXPECT_EQ(pass(1ms), "185 D0 07 00 00 FE FF");
  EXPECT_EQ(pass(1ms), "");
}

TEST_F(EncoderNode, AppliesItsPresetFromTheNextMeasurementOn) {
  pass(1ms);
  EXPECT_EQ(ask("605 23 03 60 00 0A 00 00 00"), "585 60 03 60 00 00 00 00 00");
  EXPECT_EQ(pass(1ms), "185 0A 00 00 00 FE FF");
  device.sensor().steps = 1'003;
  EXPECT_EQ(pass(1ms), "185 0D 00 00 00 FE FF");
}

TEST_F(EncoderNode, HasOneCyclicTimerInTwoPlaces) {
  EXPECT_EQ(ask("605 2B 00 62 00 14 00 00 00"), "585 60 00 62 00 00 00 00 00");
  EXPECT_EQ(ask("605 40 00 18 05 00 00 00 00"), "585 4B 00 18 05 14 00 00 00");
  EXPECT_EQ(ask("605 2B 00 18 05 05 00 00 00"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(ask("605 40 00 62 00 00 00 00 00"), "585 4B 00 62 00 05 00 00 00");
}

}  // namespace
