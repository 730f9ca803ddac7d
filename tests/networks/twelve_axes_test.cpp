/// The master of examples/networks/twelve_axes.json with its twelve drives.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

#include "networks/twelve_axes_bench.hpp"

namespace {

using namespace std::chrono_literals;
using canopen::NmtState;
using plant_bench::Axes;
namespace od = ezd_1136::od;

TEST(TwelveAxes, EachAxisFollowsTheOneBefore) {
  Axes bench;
  bench.start();
  ASSERT_TRUE(bench.boot(20s));
  bench.control.move_to(100'000, 5'000);
  for (std::size_t i = 1; i <= 12; ++i) {
    bench.node(i).set(od::position_actual_value{}, canopen::raw(static_cast<std::int32_t>(1'000 * i)));
  }
  bench.bus.run_for(100ms);
  EXPECT_EQ(canopen::to_raw(bench.node(1).get(od::target_position{})), 100'000);
  for (std::size_t i = 2; i <= 12; ++i) {
    EXPECT_EQ(canopen::to_raw(bench.node(i).get(od::target_position{})), static_cast<std::int32_t>(1'000 * (i - 1)))
        << i;
    EXPECT_EQ(canopen::to_raw(bench.node(i).get(od::profile_velocity{})), 5'000U) << i;
    EXPECT_EQ(bench.node(i).state(), NmtState::operational) << i;
  }
  EXPECT_EQ(bench.plant().axis12.position_actual_value()->raw(), 12'000);
}

/// Of the file: "period_us": 9000, and each PDO with "every_sync": 1.
TEST(TwelveAxes, EachPeriodHasAllPdos) {
  Axes bench;
  bench.start();
  ASSERT_TRUE(bench.boot(20s));
  bench.bus.run_for(1s);
  bench.forget();
  bench.bus.run_for(900ms);
  EXPECT_EQ(bench.count(0x080), 100U);
  for (std::uint32_t axis = 1; axis <= 12; ++axis) {
    EXPECT_EQ(bench.count(twelve_axes::axis1::Tpdo2::parameters.cob_id - 1 + axis), 100U) << axis;
  }
}

TEST(TwelveAxes, ADriveThatLosesPowerIsBootedAgainWhileTheOthersRun) {
  Axes bench;
  bench.start();
  ASSERT_TRUE(bench.boot(20s));
  bench.bus.run_for(1s);
  bench.axes[4].switch_off();
  bench.forget();
  bench.bus.run_for(900ms);
  EXPECT_EQ(bench.count(0x080), 100U);
  EXPECT_EQ(bench.count(twelve_axes::axis4::Tpdo2::parameters.cob_id), 100U);
  EXPECT_FALSE(bench.plant().axis5.position_actual_value().has_value());
  ASSERT_FALSE(bench.faults.empty());
  EXPECT_EQ(bench.faults[0], "axis5: lost, last state operational");

  bench.axes[4].switch_on();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(100ms);
  EXPECT_EQ(bench.boots["axis5"], 2);
  for (const char* other : {"axis1", "axis4", "axis6", "axis12"}) EXPECT_EQ(bench.boots[other], 1) << other;
  EXPECT_EQ(bench.node(5).state(), NmtState::operational);
  bench.node(5).set(od::position_actual_value{}, canopen::raw(55'555));
  bench.bus.run_for(100ms);
  EXPECT_EQ(canopen::to_raw(bench.node(6).get(od::target_position{})), 55'555);
}

}  // namespace
