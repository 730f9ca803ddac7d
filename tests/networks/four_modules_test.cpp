/// The master of examples/networks/four_modules.json with its four modules.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "networks/four_modules_bench.hpp"

namespace {

using namespace std::chrono_literals;
using canopen::NmtState;
using plant_bench::Modules;
using Bytes = std::vector<std::uint8_t>;

TEST(FourModules, AllNodesAreConfiguredAndStarted) {
  Modules bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(1s);
  // Manual 003: the modules report each reset.
  std::ranges::sort(bench.faults);
  EXPECT_EQ(bench.faults,
            (std::vector<std::string>{"analog_inputs: EMCY FF00h: request to reset node or communication",
                                      "analog_outputs: EMCY FF00h: request to reset node or communication",
                                      "digital_inputs: EMCY FF00h: request to reset node or communication",
                                      "digital_outputs: EMCY FF00h: request to reset node or communication"}));
  for (const char* name : {"digital_outputs", "digital_inputs", "analog_outputs", "analog_inputs"}) {
    EXPECT_EQ(bench.boots[name], 1) << name;
  }
  EXPECT_EQ(bench.plant().digital_outputs.state(), NmtState::operational);
  EXPECT_EQ(bench.plant().analog_inputs.state(), NmtState::operational);
  // The values of the network file: "heartbeat_ms", "every_ms".
  EXPECT_EQ(canopen::to_raw(bench.digital_outputs.node().get(can_2057c::od::producer_heartbeat_time{})), 500);
  EXPECT_EQ(
      canopen::to_raw(bench.analog_inputs.node().get(can_2017c::od::tpdo_communication_parameter_2::event_timer{})),
      1000);
  // The master sends its heartbeat in Operational.
  EXPECT_EQ(bench.last(0x77F), Bytes{0x05});
}

TEST(FourModules, OutputsFollowInputs) {
  Modules bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<2>{}, canopen::raw(0xA5));
  bench.analog_inputs.node().set(can_2017c::od::read_analogue_input_16_bit<1>{}, canopen::raw(-1234));
  bench.bus.run_for(2s);
  EXPECT_EQ(bench.plant().digital_inputs.read_input_8_bit_2()->raw(), 0xA5);
  EXPECT_EQ(canopen::to_raw(bench.digital_outputs.node().get(can_2057c::od::write_output_8_bit<2>{})), 0xA5);
  EXPECT_EQ(canopen::to_raw(bench.analog_outputs.node().get(can_2024c::od::write_analogue_output_16_bit<1>{})), -1234);
  EXPECT_EQ(bench.last(0x201), (Bytes{0x00, 0xA5}));
  EXPECT_EQ(bench.last(0x303), (Bytes{0x2E, 0xFB, 0, 0, 0, 0, 0, 0}));  // -1234 is FB2Eh
}

TEST(FourModules, ANodeThatLosesPowerIsBootedAgainWhileTheOthersRun) {
  Modules bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(2s);
  ASSERT_TRUE(bench.plant().analog_inputs.read_analogue_input_16_bit_1().has_value());
  bench.analog_inputs.switch_off();
  bench.forget();
  bench.bus.run_for(3s);
  ASSERT_FALSE(bench.faults.empty());
  EXPECT_EQ(bench.faults.front(), "analog_inputs: lost, last state operational");
  EXPECT_FALSE(bench.plant().analog_inputs.booted());
  EXPECT_FALSE(bench.plant().analog_inputs.read_analogue_input_16_bit_1().has_value());
  bench.digital_inputs.node().set(can_2053c::od::read_input_8_bit<1>{}, canopen::raw(std::uint8_t{0x3C}));
  bench.bus.run_for(1s);
  EXPECT_EQ(canopen::to_raw(bench.digital_outputs.node().get(can_2057c::od::write_output_8_bit<1>{})), 0x3C);
  EXPECT_GE(bench.count(0x201), 70U);  // each 50 ms

  bench.analog_inputs.switch_on();
  ASSERT_TRUE(bench.boot(10s));
  bench.bus.run_for(2s);
  EXPECT_EQ(bench.boots["analog_inputs"], 2);
  EXPECT_EQ(bench.boots["digital_outputs"], 1);
  EXPECT_EQ(bench.count_boot_ups(1) + bench.count_boot_ups(2) + bench.count_boot_ups(3), 0U);
  EXPECT_EQ(bench.analog_inputs.node().state(), NmtState::operational);
  EXPECT_EQ(
      canopen::to_raw(bench.analog_inputs.node().get(can_2017c::od::tpdo_communication_parameter_2::event_timer{})),
      1000);
  EXPECT_TRUE(bench.plant().analog_inputs.read_analogue_input_16_bit_1().has_value());
}

TEST(FourModules, AFaultNamesTheNode) {
  Modules bench;
  bench.start();
  ASSERT_TRUE(bench.boot(10s));
  bench.forget();
  bench.digital_outputs.node().emergency(0x5000, canopen::ErrorRegister::generic);
  bench.bus.run_for(100ms);
  ASSERT_EQ(bench.faults.size(), 1U);
  EXPECT_EQ(bench.faults[0].substr(0, 27), "digital_outputs: EMCY 5000h");
}

/// The inputs are where the outputs should be.
TEST(FourModules, AnotherDeviceIsNotConfigured) {
  struct Wrong : plant_bench::PlantBench<FourModules> {
    Wrong() : PlantBench{125'000} {}
    plant_bench::LiveNode<can_2053c::Device> digital_outputs{bus, 1};
    plant_bench::LiveNode<can_2053c::Device> digital_inputs{bus, 2};
  } bench;
  bench.start();
  bench.bus.run_for(5s);
  EXPECT_EQ(bench.boots["digital_inputs"], 1);
  EXPECT_EQ(bench.boots["digital_outputs"], 0);
  std::size_t found = 0;
  for (const std::string& fault : bench.faults) {
    found +=
        fault ==
        "../../eds/can-2057c.eds:80: digital_outputs: device type 1000h is not the one of 1F84h: expected 00020191h, "
        "seen 00010191h";
  }
  EXPECT_EQ(found, 1U);
}

}  // namespace
