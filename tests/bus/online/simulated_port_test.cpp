/// A device in simulated time, as the conformance test uses it: stimuli from outside the bus.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <canopen/nmt_master/nmt_master.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "online/simulated_port.hpp"

namespace edsc {
namespace {

using canopen::Duration;
using canopen::ErrorRegister;
using canopen::Frame;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// Node 5; its boot-up message has been received at 55 us.
class SimulatedDevice : public testing::Test {
 protected:
  SimulatedDevice() { EXPECT_EQ(next(), "55 705 00"); }

  /// The next frame within 10 ms with its time, or an empty text.
  std::string next() {
    const auto frame = port.receive(10ms);
    if (!frame) return "";
    EXPECT_EQ(port.received_at(), port.now());
    std::string text = fmt::format("{} {:03X}", port.now().since_start().count(), frame->id);
    if (frame->size != 0) text += ' ';
    for (std::size_t i = 0; i < frame->size; ++i) text += fmt::format("{:02X}", frame->data.at(i));
    return text;
  }

  SimulatedPort port{"simulated:" EDSC_SIMULATED_DEVICES "@5,live"};
};

using Bytes = std::vector<std::uint8_t>;
const Frame read_device_type{0x605, 8, false, false, {0x40, 0x00, 0x10, 0x00}};

TEST_F(SimulatedDevice, TimePassesInReceiveAlone) {
  EXPECT_EQ(port.now(), TimePoint{Duration{55}});
  EXPECT_FALSE(port.receive(100us));
  EXPECT_EQ(port.now(), TimePoint{Duration{155}});
  EXPECT_EQ(port.received_at(), TimePoint{Duration{55}});
  EXPECT_FALSE(port.receive(30min));
  EXPECT_FALSE(port.receive(30min));
  EXPECT_FALSE(port.receive(30min));
  EXPECT_TRUE(port.send(read_device_type));
  EXPECT_EQ(next(), std::to_string(static_cast<std::uint32_t>(155 + 5'400'000'000 + 222)) + " 585 4300100092010200");
}

TEST_F(SimulatedDevice, TheApplicationSetsObjectsWhileFramesWait) {
  EXPECT_TRUE(port.send(read_device_type));
  EXPECT_TRUE(port.send(canopen::nmt_frame(canopen::NmtCommand::start, canopen::NodeId{5})));
  EXPECT_EQ(port.set(0x6041, 0, Bytes{0x31, 0x02}), canopen::ok);
  EXPECT_EQ(port.set(0x6041, 0, Bytes{0x31}), canopen::AbortCode::length_too_low);
  EXPECT_EQ(port.set(0x1000, 0, Bytes(4)), canopen::AbortCode::read_only);
  EXPECT_EQ(port.now(), TimePoint{Duration{55}});
  EXPECT_EQ(next(), "340 585 4300100092010200");  // after 111 us for the request and 63 us for NMT
  EXPECT_EQ(next(), "435 185 310240E20100");
}

TEST_F(SimulatedDevice, TheApplicationReportsErrors) {
  EXPECT_TRUE(port.emergency(0x2310, ErrorRegister::current));
  EXPECT_EQ(next(), "166 085 1023030000000000");
  EXPECT_TRUE(port.emergency_over(ErrorRegister::current));
  EXPECT_EQ(next(), "277 085 0000000000000000");
  EXPECT_TRUE(port.emergency_over(ErrorRegister::current));
  EXPECT_EQ(next(), "");
}

TEST_F(SimulatedDevice, PowerCycle) {
  EXPECT_EQ(port.set(0x1017, 0, Bytes{0x0A, 0x00}), canopen::ok);
  EXPECT_EQ(next(), "110 705 7F");
  EXPECT_TRUE(port.power_cycle());
  EXPECT_EQ(next(), "165 705 00");
  EXPECT_EQ(next(), "");
}

TEST_F(SimulatedDevice, FramesOfAllKinds) {
  EXPECT_TRUE(port.send({0x1FFF'FFFF, 8, true, false, {}}));
  EXPECT_TRUE(port.send({0x123, 0, false, false, {}}));
  EXPECT_TRUE(port.send({0x705, 1, false, true, {}}));
  EXPECT_FALSE(port.receive(1ms));
}

TEST(SimulatedPort, SendsAsManyFramesAsOneLikes) {
  SimulatedPort port{"simulated:" EDSC_SIMULATED_DEVICES "@5"};
  for (int i = 0; i < 10'000; ++i) EXPECT_TRUE(port.send(read_device_type));
  EXPECT_TRUE(port.receive(2s));  // 605h has priority over 705h
  EXPECT_EQ(port.now(), TimePoint{Duration{10'000 * 111 + 55}});
}

/// A program with fewer functions than those of the runtime.
TEST(SimulatedPort, AProgramMayBeUnableToDoSomething) {
  const std::string path = testing::TempDir() + "edsc_simulation_without_stimuli";
  std::FILE* const file = std::fopen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  std::fputs("#!/bin/sh\necho edsc-simulation 1\nread line; echo ok\nwhile read line; do echo no; done\n", file);
  std::fclose(file);
  ::chmod(path.c_str(), 0755);
  {
    SimulatedPort port{"simulated:" + path + "@5"};
    EXPECT_EQ(port.set(0x2000, 0, {}), std::nullopt);
    EXPECT_FALSE(port.emergency(0x1000, ErrorRegister::generic));
    EXPECT_FALSE(port.emergency_over(ErrorRegister::generic));
    EXPECT_FALSE(port.power_cycle());
  }
  ::unlink(path.c_str());
}

TEST(SimulatedPort, AfterItsEndEachUseIsAnError) {
  SimulatedPort port{"simulated:" EDSC_SIMULATED_DEVICES "@5"};
  EXPECT_TRUE(port.send({0x123, 9, false, true, {}}));  // not a valid frame length
  EXPECT_THROW((void)port.receive(1ms), BusLost);
  EXPECT_TRUE(port.send(read_device_type));
  EXPECT_THROW((void)port.receive(1ms), BusLost);
  EXPECT_THROW((void)port.power_cycle(), BusLost);
}

}  // namespace
}  // namespace edsc
