/// Velocity mode (2) and cyclic synchronous velocity (9): the motion is compared with v = a t.
#include <gtest/gtest.h>

#include "every_mode_bench.hpp"

namespace {

using namespace std::chrono_literals;
namespace od = every_mode::od;
namespace mode = canopen::cia402::mode;

constexpr unsigned runs = 0x7F;  // bits 4, 5 and 6: ramp enabled, unlocked, with the reference

struct VelocityMode : testing::Test, bench::EveryMode<> {
  VelocityMode() { enable(mode::velocity, runs); }
  void target(int velocity) { EXPECT_EQ(write(0x6042, 0, velocity, 2), 0u); }
  [[nodiscard]] std::int32_t velocity() { return axis().velocity(); }
};

TEST_F(VelocityMode, AcceleratesAndDeceleratesWithItsSlopes) {  // 6048h: 1000 per s, 6049h: 2000 per s
  target(1'000);
  pass(500ms);
  EXPECT_NEAR(velocity(), 500, 5);
  EXPECT_NEAR(get<od::vl_velocity_demand>(), 500, 5);
  EXPECT_FALSE(bit(10));
  pass(510ms);
  EXPECT_EQ(velocity(), 1'000);
  EXPECT_EQ(get<od::vl_velocity_actual_value>(), 1'000);
  EXPECT_TRUE(bit(10)) << "target reached";
  target(0);
  pass(250ms);
  EXPECT_NEAR(velocity(), 500, 5);
  pass(260ms);
  EXPECT_EQ(velocity(), 0);
}

TEST_F(VelocityMode, HasASlopeOfSpeedPerTime) {
  EXPECT_EQ(write(0x6048, 2, 4, 2), 0u);  // 1000 in 4 s
  target(-1'000);
  pass(1s);
  EXPECT_NEAR(velocity(), -250, 5);
}

TEST_F(VelocityMode, KeepsBetweenMinAndMaxAmount) {
  EXPECT_EQ(write(0x6046, 1, 100, 4), 0u);
  EXPECT_EQ(write(0x6046, 2, 300, 4), 0u);
  for (const auto& [wanted, expected] :
       {std::pair{1'000, 300}, {-1'000, -300}, {50, 100}, {-50, -100}, {0, 0}, {200, 200}}) {
    target(wanted);
    pass(1s);
    EXPECT_EQ(velocity(), expected) << wanted;
  }
}

TEST_F(VelocityMode, AppliesBothFactors) {
  EXPECT_EQ(write(0x604B, 1, 2, 2), 0u);
  EXPECT_EQ(write(0x604C, 2, 4, 4), 0u);
  target(1'000);
  pass(2s);
  EXPECT_EQ(velocity(), 500) << "1000 * 2/1 * 1/4";
  EXPECT_EQ(get<od::vl_velocity_demand>(), 1'000) << "in the unit of the target";
  EXPECT_EQ(write(0x604C, 2, 0, 4), 0u);
  pass(2s);
  EXPECT_EQ(velocity(), 2'000) << "a factor with a 0 is not used";
}

TEST_F(VelocityMode, LocksTheRampWithBit5) {
  target(1'000);
  pass(400ms);
  control(0x5F);
  pass(500ms);
  EXPECT_NEAR(velocity(), 400, 5);
  control(runs);
  pass(700ms);
  EXPECT_EQ(velocity(), 1'000);
}

TEST_F(VelocityMode, StopsWithoutReferenceAndWithoutRamp) {
  for (const unsigned word : {0x3Fu, 0x6Fu}) {
    target(1'000);
    control(runs);
    pass(1100ms);
    EXPECT_EQ(velocity(), 1'000);
    control(word);
    pass(250ms);
    EXPECT_NEAR(velocity(), 500, 5) << "the slope of 6049h";
    pass(300ms);
    EXPECT_EQ(velocity(), 0);
  }
}

TEST_F(VelocityMode, HaltsWithItsDecelerationAndGoesOn) {
  target(1'000);
  pass(1100ms);
  control(runs | 0x100);
  pass(250ms);
  EXPECT_NEAR(velocity(), 500, 5);
  EXPECT_FALSE(bit(10));
  pass(300ms);
  EXPECT_EQ(velocity(), 0);
  EXPECT_TRUE(bit(10)) << "halt: the velocity is 0";
  control(runs);
  pass(1100ms);
  EXPECT_EQ(velocity(), 1'000);
}

TEST_F(VelocityMode, StopsQuicklyWith604Ah) {  // 10000 per s
  target(1'000);
  pass(1100ms);
  control(0x02);
  pass(50ms);
  EXPECT_NEAR(velocity(), 500, 20);
  EXPECT_EQ(status() & 0x6F, 0x07u) << "quick stop active";
  pass(60ms);
  EXPECT_EQ(velocity(), 0);
  EXPECT_EQ(status() & 0x4F, 0x40u) << "switch on disabled";
}

TEST_F(VelocityMode, StopsAtALimitSwitch) {
  axis().positive_limit = 100;
  target(1'000);
  pass(3s);
  EXPECT_EQ(velocity(), 0);
  EXPECT_TRUE(bit(11));
  target(-1'000);
  pass(1s);
  EXPECT_LT(velocity(), 0);
}

struct CyclicVelocity : testing::Test, bench::EveryMode<> {
  CyclicVelocity() { enable(mode::cyclic_synchronous_velocity); }
  void target(int velocity) { EXPECT_EQ(write(0x60FF, 0, velocity, 4), 0u); }
};

TEST_F(CyclicVelocity, FollowsTargetAndOffsetWithinThePeriod) {  // 60C2h: 10 ms
  EXPECT_TRUE(bit(12)) << "the drive follows the command";
  target(500);
  EXPECT_EQ(write(0x60B1, 0, -100, 4), 0u);
  pass(5ms);
  EXPECT_NEAR(axis().velocity_demand(), 200, 45);
  pass(10ms);
  EXPECT_EQ(axis().velocity(), 400);
  EXPECT_EQ(get<od::velocity_actual_value>(), 400);
}

TEST_F(CyclicVelocity, KeepsToTheHighestProfileVelocity) {
  EXPECT_EQ(write(0x607F, 0, 300, 4), 0u);
  target(-10'000);
  pass(50ms);
  EXPECT_EQ(axis().velocity(), -300);
}

TEST_F(CyclicVelocity, StopsInHaltAndAtALimitSwitch) {
  target(1'000);
  pass(100ms);
  control(0x10F);
  EXPECT_FALSE(bit(12));
  pass(100ms);
  EXPECT_EQ(axis().velocity(), 0);
  control(0x0F);
  EXPECT_TRUE(bit(12));
  pass(100ms);
  EXPECT_EQ(axis().velocity(), 1'000);
  axis().hold(canopen::cia402::input::positive_limit, true);
  pass(100ms);
  EXPECT_EQ(axis().velocity(), 0);
}

}  // namespace
