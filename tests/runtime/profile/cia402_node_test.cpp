/// A whole drive node: device control from the frames of a master, with the motor of the example.
#include <gtest/gtest.h>

#include <canopen/profile/cia402_node.hpp>
#include <cia402_drive/device.hpp>
#include <cstdint>
#include <string>

#include "servo/motor.hpp"
#include "support/bench.hpp"

namespace {

using canopen::cia402::State;
using namespace std::chrono_literals;
namespace od = cia402_drive::od;

struct DriveNode : testing::Test {
  DriveNode() {
    drive.start(now);
    ask(bench::start);
  }
  std::string ask(const std::string& request) {
    drive.on_frame(bench::frame(request), now);
    return bus.take();
  }
  /// The bits of the statusword that are the state (CiA 402-2, table 30).
  unsigned state() { return drive.node().get(od::statusword{}).raw() & 0x6Fu; }

  bench::RecordingBus bus;
  canopen::TimePoint now{};
  canopen::cia402::DriveNode<cia402_drive::Device, bench::RecordingBus, Motor> drive{bus, canopen::NodeId{5}};
};

TEST_F(DriveNode, FollowsTheControlword) {
  ask("205 06 00");
  EXPECT_EQ(state(), 0x21u) << "ready to switch on";
  ask("205 07 00");
  EXPECT_EQ(state(), 0x23u) << "switched on";
  ask("205 0F 00");
  EXPECT_EQ(state(), 0x27u) << "operation enabled";
  EXPECT_TRUE(drive.axis().powered);
}

TEST_F(DriveNode, HasNoPowerAfterAnNmtReset) {
  for (const char* word : {"205 06 00", "205 07 00", "205 0F 00"}) ask(word);
  EXPECT_EQ(ask(bench::reset_node), "705 00");
  EXPECT_EQ(drive.drive().state(), State::switch_on_disabled);
  EXPECT_FALSE(drive.axis().powered);
}

TEST_F(DriveNode, ReportsAFaultAndEndsIt) {
  for (const char* word : {"205 06 00", "205 07 00", "205 0F 00"}) ask(word);
  // A constant that is not an emergency error code does not compile.
  drive.fault(canopen::EmergencyCode{0x2310}, canopen::ErrorRegister::current, now);
  EXPECT_NE(bus.take().find("085 10 23 03"), std::string::npos) << "EMCY: current and generic";
  EXPECT_EQ(state() & 0x4F, 0x08u) << "fault; the bit of quick stop does not matter";
  EXPECT_FALSE(drive.axis().powered);
  ask("205 00 00");
  EXPECT_NE(ask("205 80 00").find("085 00 00 00"), std::string::npos) << "the error is over";
  EXPECT_EQ(state() & 0x4F, 0x40u) << "switch on disabled";
}

TEST_F(DriveNode, StepsTheAxisWhileItHasPower) {
  for (const char* word : {"205 06 00", "205 07 00", "205 0F 00"}) ask(word);
  ASSERT_TRUE(drive.next_deadline().has_value());
  EXPECT_LE(*drive.next_deadline(), now + 10ms);
}

}  // namespace
