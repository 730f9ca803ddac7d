/// The modes of operation of CiA 402: controlword and statusword bits as bytes, and the motion of the axis.
#include <gtest/gtest.h>

#include "cia402_bench.hpp"

namespace {

using namespace std::chrono_literals;
using bench::DriveBench;
namespace od = bench::od;
namespace mode = canopen::cia402::mode;

// Profile position. 10'000 increments take 1.1 s with the ramps of the EDS.

struct Positioning : DriveBench {
  Positioning() { enable(mode::profile_position); }
};

TEST(ProfilePosition, AcknowledgesASetPointAndReachesIt) {
  Positioning drive;
  EXPECT_EQ(drive.control(0x1F, 10'000), "185 37 12");  // bit 12, and bit 10 falls
  EXPECT_EQ(drive.control(0x0F), "185 37 02");          // bit 4 and bit 12 fall
  EXPECT_EQ(drive.pass(1'050ms), "");
  EXPECT_EQ(drive.pass(100ms), "185 37 06");
  EXPECT_EQ(drive.position(), 10'000);
  EXPECT_EQ(drive.get<od::position_actual_value>(), 10'000);
}

TEST(ProfilePosition, NeedsARisingEdgeOfBit4) {
  Positioning drive;
  drive.control(0x1F, 100);
  drive.pass(1s);
  EXPECT_EQ(drive.control(0x1F, 500), "");
  drive.pass(1s);
  EXPECT_EQ(drive.position(), 100);
}

TEST(ProfilePosition, KeepsOneSetPointBehindTheOneInProgress) {
  Positioning drive;
  drive.control(0x1F, 2'000);
  drive.control(0x0F);
  EXPECT_EQ(drive.control(0x1F, 1'000), "185 37 12");
  EXPECT_EQ(drive.control(0x0F), "");         // bit 12 remains 1: the buffer is full
  EXPECT_EQ(drive.control(0x1F, 9'000), "");  // ignored
  EXPECT_EQ(drive.control(0x0F), "");
  EXPECT_EQ(drive.pass(400ms), "185 37 02");  // at 2'000 the next set-point starts
  EXPECT_EQ(drive.pass(1s), "185 37 06");
  EXPECT_EQ(drive.position(), 1'000);
}

TEST(ProfilePosition, ChangesTheSetPointImmediatelyWithBit5) {
  Positioning drive;
  drive.control(0x1F, 10'000);
  drive.control(0x0F);
  drive.pass(300ms);
  EXPECT_EQ(drive.control(0x3F, 1'000), "185 37 12");
  EXPECT_EQ(drive.control(0x0F), "185 37 02");
  EXPECT_EQ(drive.pass(2s), "185 37 06");
  EXPECT_EQ(drive.position(), 1'000);
}

TEST(ProfilePosition, CountsFromTheLastTargetWithBit6) {
  Positioning drive;
  drive.control(0x5F, 1'000);
  drive.control(0x4F);
  drive.control(0x5F, -300);  // after the first set-point
  drive.control(0x4F);
  drive.pass(2s);
  EXPECT_EQ(drive.position(), 700);
  drive.control(0x7F, 50);
  drive.pass(1s);
  EXPECT_EQ(drive.position(), 750);
}

TEST(ProfilePosition, KeepsToVelocityAndRamps) {
  Positioning drive;
  drive.set<od::profile_velocity>(5'000);
  drive.set<od::profile_acceleration>(50'000);
  drive.set<od::profile_deceleration>(25'000);
  drive.control(0x1F, 10'000);
  drive.pass(51ms);
  EXPECT_NEAR(drive.velocity(), 2'500, 60);
  drive.pass(100ms);
  EXPECT_EQ(drive.velocity(), 5'000);
  drive.set<od::max_profile_velocity>(1'000);  // applies from the next set-point
  drive.control(0x2F);
  drive.control(0x3F, 10'000);
  drive.pass(500ms);
  EXPECT_EQ(drive.velocity(), 1'000);
}

TEST(ProfilePosition, HaltsAndGoesOn) {
  Positioning drive;
  drive.control(0x1F, 10'000);
  drive.pass(500ms);
  EXPECT_EQ(drive.control(0x11F), "");
  EXPECT_EQ(drive.pass(200ms), "185 37 16");  // bit 10: the axis is at rest
  EXPECT_LT(drive.position(), 8'000);
  EXPECT_EQ(drive.control(0x1F), "185 37 12");
  EXPECT_EQ(drive.pass(1s), "185 37 16");
  EXPECT_EQ(drive.position(), 10'000);
}

TEST(ProfilePosition, ReachesATargetAfterTheWindowTime) {
  Positioning drive;
  drive.set<od::position_window>(10);
  drive.set<od::position_window_time>(100);
  drive.control(0x1F, 1'000);
  drive.pass(50ms);
  EXPECT_EQ(drive.pass(230ms), "");
  EXPECT_EQ(drive.position(), 1'000);
  EXPECT_EQ(drive.pass(100ms), "185 37 16");
}

TEST(ProfilePosition, StopsAtASoftwareLimit) {
  Positioning drive;
  drive.set<od::software_position_limit<1>>(-500);
  drive.set<od::software_position_limit<2>>(2'000);
  drive.control(0x1F, 10'000);
  EXPECT_EQ(drive.pass(2s), "185 37 1A | 185 37 1E");  // bit 11, internal limit, then bit 10
  EXPECT_EQ(drive.position(), 2'000);
  drive.control(0x0F);
  drive.control(0x1F, -10'000);
  drive.pass(2s);
  EXPECT_EQ(drive.position(), -500);
}

TEST(ProfilePosition, StopsAtALimitSwitchAndGoesBackOnly) {
  Positioning drive;
  drive.app->axis().positive_limit = 1'000;
  drive.control(0x1F, 10'000);
  drive.pass(1s);
  EXPECT_EQ(drive.statusword() & 0x0800, 0x0800);
  const std::int32_t stopped = drive.position();
  EXPECT_NEAR(stopped, 1'050, 60);
  drive.control(0x0F);
  drive.control(0x1F, 10'000);
  drive.pass(1s);
  EXPECT_EQ(drive.position(), stopped);
  drive.control(0x0F);
  drive.control(0x1F, 0);
  drive.pass(1s);
  EXPECT_EQ(drive.position(), 0);
  EXPECT_EQ(drive.statusword() & 0x0800, 0);
}

TEST(ProfilePosition, TellsAFollowingErrorAfterItsTime) {
  Positioning drive;
  drive.set<od::following_error_window>(100);
  drive.set<od::following_error_time_out>(50);
  drive.control(0x1F, 10'000);
  drive.pass(100ms);
  drive.input("block on");
  EXPECT_EQ(drive.pass(40ms), "");
  EXPECT_EQ(drive.pass(50ms), "185 37 32");  // bit 13
  EXPECT_GT(drive.get<od::following_error_actual_value>(), 100);
  drive.input("block off");
  EXPECT_EQ(drive.pass(10ms), "185 37 12");
}

// Profile velocity

TEST(ProfileVelocity, RunsAtTheTargetVelocity) {
  DriveBench drive;
  drive.set<od::modes_of_operation>(mode::profile_velocity);
  drive.control(0x06);
  drive.control(0x07);
  EXPECT_EQ(drive.control(0x0F), "185 37 16");  // 0 is reached, and the speed is 0
  drive.set<od::target_velocity>(10'000);
  EXPECT_EQ(drive.pass(90ms), "185 37 12 | 185 37 02");  // bit 10, then bit 12
  EXPECT_EQ(drive.pass(20ms), "185 37 06");
  EXPECT_EQ(drive.get<od::velocity_actual_value>(), 10'000);
  drive.set<od::target_velocity>(-10'000);
  EXPECT_EQ(drive.pass(300ms), "185 37 02 | 185 37 12 | 185 37 02 | 185 37 06");
  EXPECT_EQ(drive.velocity(), -10'000);
}

TEST(ProfileVelocity, KeepsToTheHighestProfileVelocity) {
  DriveBench drive;
  drive.set<od::max_profile_velocity>(4'000);
  drive.set<od::target_velocity>(10'000);
  drive.enable(mode::profile_velocity);
  drive.pass(1s);
  EXPECT_EQ(drive.velocity(), 4'000);
}

TEST(ProfileVelocity, HaltsAndGoesOn) {
  DriveBench drive;
  drive.run(10'000);
  EXPECT_EQ(drive.control(0x10F), "185 37 02");
  EXPECT_EQ(drive.pass(200ms), "185 37 16");
  EXPECT_EQ(drive.control(0x0F), "185 37 12");
  EXPECT_EQ(drive.pass(200ms), "185 37 02 | 185 37 06");
}

TEST(ProfileVelocity, ReachesTheTargetWithinTheWindowForItsTime) {
  DriveBench drive;
  drive.set<od::velocity_window>(1'000);
  drive.set<od::velocity_window_time>(50);
  drive.set<od::velocity_threshold>(100);
  drive.set<od::target_velocity>(10'000);
  drive.enable(mode::profile_velocity);
  EXPECT_EQ(drive.pass(130ms), "185 37 02");
  EXPECT_EQ(drive.pass(20ms), "185 37 06");
}

TEST(ProfileVelocity, StopsAtASoftwareLimitAndGoesBackOnly) {
  DriveBench drive;
  drive.set<od::software_position_limit<1>>(-1'000);
  drive.set<od::software_position_limit<2>>(5'000);
  drive.set<od::target_velocity>(10'000);
  drive.enable(mode::profile_velocity);
  drive.pass(2s);
  EXPECT_EQ(drive.statusword(), 0x1A37);  // bits 11 and 12, not bit 10
  EXPECT_NEAR(drive.position(), 5'050, 60);
  drive.set<od::target_velocity>(-10'000);
  drive.pass(300ms);
  EXPECT_EQ(drive.velocity(), -10'000);
  EXPECT_EQ(drive.statusword(), 0x0637);
}

// Cyclic synchronous position

TEST(CyclicSynchronousPosition, FollowsTheTargetPosition) {
  DriveBench drive;
  drive.enable(mode::cyclic_synchronous_position);
  EXPECT_EQ(drive.statusword() & 0xFBFF, 0x1237);  // bit 12: the drive follows
  for (std::int32_t target = 100; target <= 1'000; target += 100) {
    drive.control(0x0F, target);
    drive.pass(2ms);
    EXPECT_EQ(drive.position(), target);
  }
  drive.set<od::position_offset>(50);
  drive.pass(2ms);
  EXPECT_EQ(drive.position(), 1'050);
}

TEST(CyclicSynchronousPosition, FollowsNoMoreInHalt) {
  DriveBench drive;
  drive.enable(mode::cyclic_synchronous_position);
  drive.control(0x10F, 1'000);
  EXPECT_EQ(drive.statusword() & 0x1000, 0);
  drive.pass(10ms);
  EXPECT_EQ(drive.position(), 0);
}

TEST(CyclicSynchronousPosition, TellsAFollowingError) {
  DriveBench drive;
  drive.set<od::following_error_window>(100);
  drive.enable(mode::cyclic_synchronous_position);
  drive.input("block on");
  drive.control(0x0F, 500);
  drive.pass(5ms);
  EXPECT_EQ(drive.statusword() & 0x2000, 0x2000);
}

// Modes

TEST(Modes, AreShownIn6061hWhenTheyHaveBegun) {
  DriveBench drive;
  EXPECT_EQ(drive.ask("605 2F 60 60 00 03 00 00 00"), "585 60 60 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 61 60 00 00 00 00 00"), "585 4F 61 60 00 03 00 00 00");
  drive.ask("605 2F 60 60 00 04 00 00 00");  // torque: the drive does not have this mode
  EXPECT_EQ(drive.ask("605 40 61 60 00 00 00 00 00"), "585 4F 61 60 00 03 00 00 00");
}

TEST(Modes, ShowTheirOwnTargetReachedAtOnce) {
  DriveBench drive;
  drive.set<od::target_velocity>(10'000);
  drive.set<od::modes_of_operation>(mode::profile_velocity);
  drive.enable(mode::homing);
  drive.pass(1s);
  EXPECT_EQ(drive.statusword() & 0x0400, 0x0400) << "no homing, and the motor rests";
  drive.ask("605 2F 60 60 00 03 00 00 00");
  EXPECT_EQ(drive.statusword() & 0x0400, 0) << "it does not turn at 10'000 yet";
}

TEST(Modes, ChangeWhenAMotorThatTurnsHasStopped) {
  DriveBench drive;
  drive.run(10'000);
  drive.set<od::modes_of_operation>(mode::homing);
  drive.pass(50ms);
  EXPECT_EQ(drive.get<od::modes_of_operation_display>(), mode::profile_velocity);
  drive.pass(100ms);
  EXPECT_EQ(drive.velocity(), 0);
  EXPECT_EQ(drive.get<od::modes_of_operation_display>(), mode::homing);
}

TEST(Modes, EndAHoming) {
  DriveBench drive;
  drive.set<od::homing_method>(17);
  drive.enable(mode::homing);
  drive.control(0x1F);
  drive.pass(500ms);
  drive.set<od::modes_of_operation>(mode::profile_position);
  drive.input("limit negative on");  // the switch that homing was looking for
  drive.pass(500ms);
  EXPECT_EQ(drive.velocity(), 0);
  EXPECT_EQ(drive.get<od::modes_of_operation_display>(), mode::profile_position);
}

TEST(Modes, GoOnInTheOldOneWhenTheChangeIsTakenBack) {
  DriveBench drive;
  drive.run(10'000);
  drive.set<od::modes_of_operation>(mode::homing);
  drive.pass(50ms);
  drive.set<od::modes_of_operation>(mode::profile_velocity);
  drive.pass(200ms);
  EXPECT_EQ(drive.velocity(), 10'000);
}

}  // namespace
