/// The master of examples/networks/eight_devices.json with one of each device.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "networks/eight_devices_bench.hpp"

namespace {

using namespace std::chrono_literals;
using canopen::NmtState;
using plant_bench::Devices;

TEST(EightDevices, SensorAndAxisAreShownByTheOutputs) {
  Devices bench;
  bench.start();
  ASSERT_TRUE(bench.boot(20s));
  bench.sensor.node().set(rk5c::od::speed_value<1>{}, canopen::raw(std::int16_t{-321}));
  bench.axis.node().set(ezd_1136::od::position_actual_value{}, canopen::raw(40'000));
  bench.bus.run_for(2s);
  EXPECT_EQ(canopen::to_raw(bench.analog_outputs.node().get(can_2024c::od::write_analogue_output_16_bit<2>{})), -321);
  EXPECT_EQ(canopen::to_raw(bench.analog_outputs.node().get(can_2024c::od::write_analogue_output_16_bit<3>{})), 32'767);
  EXPECT_EQ(bench.drive.node().state(), NmtState::operational);
  EXPECT_EQ(bench.second_drive.node().state(), NmtState::operational);
}

TEST(EightDevices, ASensorThatLosesPowerIsBootedAgainWhileTheOthersRun) {
  Devices bench;
  bench.start();
  ASSERT_TRUE(bench.boot(20s));
  bench.bus.run_for(2s);
  bench.sensor.switch_off();
  bench.forget();
  bench.bus.run_for(3s);
  ASSERT_FALSE(bench.faults.empty());
  EXPECT_EQ(bench.faults[0], "sensor: lost, last state operational");
  EXPECT_FALSE(bench.plant().sensor.speed_value_1().has_value());
  bench.axis.node().set(ezd_1136::od::position_actual_value{}, canopen::raw(123));
  bench.bus.run_for(1s);
  EXPECT_EQ(canopen::to_raw(bench.analog_outputs.node().get(can_2024c::od::write_analogue_output_16_bit<3>{})), 123);

  bench.sensor.switch_on();
  ASSERT_TRUE(bench.boot(10s));
  bench.sensor.node().set(rk5c::od::speed_value<1>{}, canopen::raw(std::int16_t{77}));
  bench.bus.run_for(2s);
  EXPECT_EQ(bench.boots["sensor"], 2);
  EXPECT_EQ(bench.boots["axis"], 1);
  EXPECT_EQ(bench.analog_outputs.node().get(can_2024c::od::write_analogue_output_16_bit<2>{}).raw(), 77);
}

}  // namespace
