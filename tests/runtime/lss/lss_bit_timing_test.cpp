/// The bit timing of an LSS slave: configuration and activation.
#include <gtest/gtest.h>

#include <canopen/lss/lss_slave.hpp>
#include <string>
#include <vector>

#include "lss_bench.hpp"

namespace {

using bench::ConfiguredDevice;
using bench::LssDevice;
using canopen::LssOptions;
using namespace std::chrono_literals;

constexpr auto inquire_node_id = "7E5 5E 00 00 00 00 00 00 00";
constexpr auto store = "7E5 17 00 00 00 00 00 00 00";

TEST(LssSlave, ConfiguresTheBitRatesOfItsDataSheet) {
  ConfiguredDevice<LssOptions{.bit_rates = 0b1'0001'0100}> device;  // 500, 125 and 10 kbit/s
  for (unsigned index = 0; index < 256; ++index) {
    canopen::Frame request = bench::frame("7E5 13 00 00 00 00 00 00 00");
    request.data[2] = static_cast<std::uint8_t>(index);
    const bool has = index == 2 || index == 4 || index == 8;
    EXPECT_EQ(device.ask(request), has ? "7E4 13 00 00 00 00 00 00 00" : "7E4 13 01 00 00 00 00 00 00") << index;
  }
}

TEST(LssSlave, HasAllRatesOfTheTableButTheReservedOneAndAutomaticDetection) {
  for (unsigned index = 0; index < 12; ++index) {
    const bool all = (canopen::lss::all_bit_rates >> index & 1) != 0;
    EXPECT_EQ(all, index < std::size(canopen::lss::bit_rates) && canopen::lss::bit_rates[index] != 0) << index;
  }
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 13 00 05 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 00 09 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  ConfiguredDevice<LssOptions{.bit_rates = 1 << canopen::lss::automatic_bit_rate}> detecting;
  EXPECT_EQ(detecting.ask("7E5 13 00 09 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
}

TEST(LssSlave, HasNoOtherBitTimingTableUnlessTheManufacturerHas) {
  ConfiguredDevice device;
  EXPECT_EQ(device.ask("7E5 13 01 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 13 80 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  ConfiguredDevice<LssOptions{.manufacturer_bit_timing = true}> own;
  EXPECT_EQ(own.ask("7E5 13 7F 00 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(own.ask("7E5 13 80 30 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");
  own.bit_timing_error = {canopen::lss::implementation_specific, 9};
  EXPECT_EQ(own.ask("7E5 13 80 31 00 00 00 00 00"), "7E4 13 FF 09 00 00 00 00 00");
  own.ask(store);
  EXPECT_EQ(own.stored_bit_timing, (canopen::LssBitTiming{128, 0x30}));
}

TEST(LssSlave, RefusesEveryBitRateWhereItIsFixed) {
  ConfiguredDevice<LssOptions{.bit_rates = 0}> device;
  EXPECT_EQ(device.ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 01 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("7E5 15 0A 00 00 00 00 00 00"), "");
  EXPECT_FALSE(device.slave.next_deadline());
}

TEST(LssSlave, SwitchesTheBitRateBetweenTwoDelays) {
  ConfiguredDevice device;
  device.ask("7E5 13 00 02 00 00 00 00 00");
  EXPECT_TRUE(device.events.empty());
  EXPECT_EQ(device.ask("7E5 15 2C 01 00 00 00 00 00"), "");  // 300 ms
  device.pass(299ms);
  EXPECT_TRUE(device.events.empty());
  EXPECT_FALSE(device.slave.silent());
  device.pass(1ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"300 ms: stop"}));
  EXPECT_TRUE(device.slave.silent());
  EXPECT_EQ(device.slave.next_deadline(), canopen::TimePoint{600ms});
  device.pass(300ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"300 ms: stop", "600 ms: start 0.2"}));
  EXPECT_FALSE(device.slave.silent());
  EXPECT_FALSE(device.slave.next_deadline());
}

TEST(LssSlave, TalksBeforeTheSwitchAndAfterItButNotInTheMiddle) {
  ConfiguredDevice device;
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.pass(9ms);
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  device.bus.room = 0;
  EXPECT_EQ(device.ask(inquire_node_id), "");
  device.pass(1ms);
  device.bus.room = 10;
  EXPECT_FALSE(device.slave.serve(device.bus));
  EXPECT_EQ(device.ask("7E5 5A 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(device.pass(9ms), "");
  EXPECT_EQ(device.pass(1ms), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
}

TEST(LssSlave, ActivatesTheBitRateThatWasPendingWhenTheCommandCame) {
  ConfiguredDevice device;
  device.ask("7E5 13 00 02 00 00 00 00 00");
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.ask("7E5 13 00 03 00 00 00 00 00");
  device.pass(20ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"10 ms: stop", "20 ms: start 0.2"}));
}

TEST(LssSlave, SwitchesTheBitRateAtOnceWithADelayOfZero) {
  ConfiguredDevice device;
  device.ask("7E5 15 00 00 00 00 00 00 00");
  device.pass(0ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"0 ms: stop", "0 ms: start 0.4"}));
}

TEST(LssSlave, EndsBothDelaysWhenServedLate) {
  ConfiguredDevice device;
  device.ask("7E5 15 0A 00 00 00 00 00 00");
  device.slave.on_time(LssDevice<>::Hooks{device}, canopen::TimePoint{25ms});
  EXPECT_EQ(device.events.size(), 2u);
  EXPECT_FALSE(device.slave.silent());
}

TEST(LssSlave, WaitsForTheLongestDelayOfAll) {
  ConfiguredDevice device;
  device.ask("7E5 15 FF FF 00 00 00 00 00");
  device.pass(131'069ms);
  EXPECT_TRUE(device.slave.silent());
  device.pass(1ms);
  EXPECT_EQ(device.events, (std::vector<std::string>{"65535 ms: stop", "131070 ms: start 0.4"}));
}

}  // namespace
