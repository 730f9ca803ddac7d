/// Profile torque (4) and cyclic synchronous torque (10): the motor accelerates in proportion to its torque.
#include <gtest/gtest.h>

#include "every_mode_bench.hpp"

namespace {

using namespace std::chrono_literals;
namespace od = every_mode::od;
namespace mode = canopen::cia402::mode;

/// Increments per second squared for 0.1 % of the torque.
constexpr int k = 100;

struct ProfileTorque : testing::Test, bench::EveryMode<> {
  ProfileTorque() { enable(mode::profile_torque); }
  void target(int torque) { EXPECT_EQ(write(0x6071, 0, torque, 2), 0u); }
};

TEST_F(ProfileTorque, RampsTheTorqueWithItsSlope) {  // 6087h: 1000 per s
  target(500);
  pass(250ms);
  EXPECT_NEAR(get<od::torque_demand>(), 250, 2);
  EXPECT_EQ(get<od::torque_actual_value>(), axis().torque());
  EXPECT_NEAR(axis().velocity(), k * 1'000 * 0.25 * 0.25 / 2, 50) << "v = k slope t^2 / 2";
  EXPECT_FALSE(bit(10));
  pass(260ms);
  EXPECT_EQ(get<od::torque_demand>(), 500);
  EXPECT_TRUE(bit(10)) << "target reached";
  target(-500);
  pass(500ms);
  EXPECT_NEAR(get<od::torque_demand>(), 0, 2);
}

TEST_F(ProfileTorque, HasSlopesBelowOneUnitPerStep) {
  EXPECT_EQ(write(0x6087, 0, 10, 4), 0u);
  target(500);
  pass(1s);
  EXPECT_NEAR(get<od::torque_demand>(), 10, 1);
}

TEST_F(ProfileTorque, AppliesTheTargetAtOnceWithoutASlope) {
  EXPECT_EQ(write(0x6087, 0, 0, 4), 0u);
  target(500);
  pass(2ms);
  EXPECT_EQ(get<od::torque_demand>(), 500);
}

TEST_F(ProfileTorque, KeepsToTheMaxTorque) {
  EXPECT_EQ(write(0x6072, 0, 300, 2), 0u);
  target(500);
  pass(1s);
  EXPECT_EQ(get<od::torque_demand>(), 300);
  EXPECT_TRUE(bit(11)) << "internal limit";
  target(-300);
  pass(1s);
  EXPECT_EQ(get<od::torque_demand>(), -300);
  EXPECT_FALSE(bit(11));
}

TEST_F(ProfileTorque, StopsInHaltAndStartsAgainFromZero) {
  target(500);
  pass(1s);
  control(0x10F);
  EXPECT_EQ(axis().torque(), 0);
  pass(2s);
  EXPECT_EQ(axis().velocity(), 0);
  EXPECT_TRUE(bit(10)) << "halt: the velocity is 0";
  control(0x0F);
  pass(100ms);
  EXPECT_NEAR(get<od::torque_demand>(), 100, 2);
}

TEST_F(ProfileTorque, StopsAtALimitAndGoesBackOnly) {
  EXPECT_EQ(write(0x607D, 1, -1'000'000, 4), 0u);
  EXPECT_EQ(write(0x607D, 2, 1'000, 4), 0u);
  target(500);
  pass(5s);
  EXPECT_EQ(axis().velocity(), 0);
  EXPECT_EQ(axis().torque(), 0);
  EXPECT_GE(axis().position(), 1'000);
  target(-100);
  pass(500ms);
  EXPECT_LT(axis().velocity(), 0);
}

TEST_F(ProfileTorque, HoldsTheAxisWhenAnotherModeBegins) {
  EXPECT_EQ(write(0x6060, 0, mode::profile_position, 1), 0u);
  pass(10ms);
  EXPECT_EQ(get<od::modes_of_operation_display>(), mode::profile_position);
  EXPECT_EQ(axis().torque(), 0);
  EXPECT_FALSE(axis().moving());
}

TEST(CyclicTorque, IsTheSumOfTargetAndOffset) {
  bench::EveryMode<> drive;
  drive.enable(mode::cyclic_synchronous_torque);
  EXPECT_TRUE(drive.bit(12)) << "the drive follows the command";
  EXPECT_EQ(drive.write(0x6071, 0, 100, 2), 0u);
  EXPECT_EQ(drive.write(0x60B2, 0, 50, 2), 0u);
  drive.pass(100ms);
  EXPECT_EQ(drive.axis().torque(), 150);
  EXPECT_EQ(drive.get<od::torque_demand>(), 150);
  EXPECT_NEAR(drive.axis().velocity(), k * 150 * 0.1, 40) << "v = k torque t";
  EXPECT_EQ(drive.write(0x60B2, 0, 0x7FFF, 2), 0u);
  drive.pass(2ms);
  EXPECT_EQ(drive.axis().torque(), 1'000) << "6072h";
  EXPECT_TRUE(drive.bit(11));
}

}  // namespace
