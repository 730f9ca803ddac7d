/// Manual 003, the CAN-2000C modules as node 5: error control, SYNC and EMCY.
#include <gtest/gtest.h>

#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::ro;
using manual::rw;
using manual::write;
using namespace std::chrono_literals;

using AnalogOutputs = bench::Bench<can_2024c::Device>;
using DigitalInputs = bench::Bench<can_2053c::Device>;
using DigitalOutputs = bench::Bench<can_2057c::Device>;

using Output = can_2057c::od::write_output_8_bit<1>;

// Error control

// shows 003.86
TEST(Manual003, TellsItsStateToTheGuard) {
  DigitalOutputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.ask("705 R 1"), "705 05");
  EXPECT_EQ(module.ask("705 R 1"), "705 85");
}

// shows 003.87
TEST(Manual003, TakesItsErrorValuesWhenTheMasterIsMissing) {
  namespace od = can_2057c::od;
  auto module = bench::with<can_2057c::Device>(canopen::on_life_guarding([](auto& node, bool lost) {
    const std::uint8_t mode = node.template get<od::error_mode_output_8_bit<1>>().raw();
    const std::uint8_t value = node.template get<od::error_value_output_8_bit<1>>().raw();
    const std::uint8_t output = node.template get<Output>().raw();
    if (lost)
      (void)node.template set<Output>(canopen::raw(static_cast<std::uint8_t>((output & ~mode) | (value & mode))));
  }));
  write(module, 0x100C, 0, 2, 250);
  write(module, 0x100D, 0, 1, 4);
  write(module, 0x6206, 1, 1, 0x0F);
  write(module, 0x6207, 1, 1, 0xA5);
  module.ask(bench::start);
  module.ask("205 F0 00");
  module.ask("705 R 1");
  EXPECT_EQ(module.pass(1s).substr(0, 27), "085 30 81 11 07 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0xF5);
}

// shows 003.91
TEST(Manual003, IsNotGuardedWhileItHasAHeartbeat) {
  DigitalOutputs module;
  write(module, 0x100C, 0, 2, 250);
  write(module, 0x100D, 0, 1, 4);
  EXPECT_EQ(module.ask("705 R 1"), "705 7F");
  EXPECT_EQ(module.ask("605 2B 17 10 00 F4 01 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(module.ask("705 R 1"), "");
  EXPECT_EQ(module.pass(2s), "705 7F | 705 7F | 705 7F | 705 7F");
}

// SYNC and EMCY

// shows 003.66, 003.179
TEST(Manual003, ConsumesSyncAtTheCobIdOf1005h) {
  DigitalInputs module;
  write(module, 0x1800, 2, 1, 1);
  EXPECT_EQ(module.ask("605 23 05 10 00 80 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 05 10 00 80 00 00 20"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 05 10 00 A0 00 00 80"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  module.ask(bench::start);
  EXPECT_EQ(module.ask("080"), "");
  EXPECT_EQ(module.ask("0A0"), "185 00 00");
}

// shows 003.68, 003.152
TEST(Manual003, SendsEmcyAtTheCobIdOf1014hOrNotAtAll) {
  DigitalOutputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.ask("605 23 14 10 00 85 00 00 80"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("205 00"), "");
  module.ask("205 00 00");
  EXPECT_EQ(module.ask("605 23 14 10 00 85 00 00 20"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 14 10 00 85 00 00 40"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 14 10 00 90 00 00 00"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("205 00"), "090 10 82 11 09 00 00 00 00");
}

// shows 003.50, 003.51, 003.69, 003.78
TEST(Manual003, TellsAPdoLengthErrorOnceAndItsEnd) {
  DigitalOutputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.ask("205 12"), "085 10 82 11 09 00 00 00 00");
  EXPECT_EQ(module.ask("205 12"), "");
  EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0);
  EXPECT_EQ(module.ask("205 12 34"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(module.ask("205"), "085 10 82 11 09 00 00 00 00");
}

struct Emergency {
  std::uint16_t code;
  ErrorRegister bits;
  std::uint8_t detail;
  const char* frame;
};

constexpr Emergency emergencies[] = {
    {0x1000, ErrorRegister::manufacturer, 1, "085 00 10 81 01 00 00 00 00"},
    {0x5000, ErrorRegister::manufacturer, 2, "085 00 50 81 02 00 00 00 00"},
    {0x8110, ErrorRegister::communication, 4, "085 10 81 11 04 00 00 00 00"},
    {0x8110, ErrorRegister::communication, 5, "085 10 81 11 05 00 00 00 00"},
    {0x8110, ErrorRegister::communication, 6, "085 10 81 11 06 00 00 00 00"},
    {0x8140, ErrorRegister::communication, 8, "085 40 81 11 08 00 00 00 00"},
};

// shows 003.82, 003.127
TEST(Manual003, SendsTheEmergenciesThatItsFirmwareFinds) {
  for (const auto& [code, bits, detail, frame] : emergencies) {
    DigitalOutputs module;
    module.node.emergency(code, bits, {detail});
    EXPECT_EQ(module.pass(0s), frame);
    EXPECT_EQ(module.ask("605 40 01 10 00 00 00 00 00"),
              bits == ErrorRegister::manufacturer ? "585 4F 01 10 00 81 00 00 00" : "585 4F 01 10 00 11 00 00 00");
  }
}

// shows 003.79, 003.172
TEST(Manual003, TellsThatItHasBeenAskedToReset) {
  DigitalOutputs node_reset;
  EXPECT_EQ(node_reset.ask(bench::reset_node), "085 00 FF 80 0A 00 00 00 00 | 705 00");
  DigitalOutputs communication_reset;
  EXPECT_EQ(communication_reset.ask(bench::reset_communication), "085 00 FF 80 0A 00 00 00 00 | 705 00");
}

// shows 003.79, 003.173
TEST(Manual003, RecordsThatItHasBeenAskedToReset) {
  for (const char* const reset : {bench::reset_node, bench::reset_communication}) {
    SCOPED_TRACE(reset);
    DigitalOutputs module;
    module.ask(bench::start);
    module.ask("205 12");
    module.ask(reset);
    EXPECT_EQ(module.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 02 00 00 00");
    EXPECT_EQ(module.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 00 FF 0A 00");
    EXPECT_EQ(module.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 10 82 09 00");
    EXPECT_EQ(module.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 00 00 00 00");
    for (int i = 0; i < 5; ++i) module.ask(reset);
    EXPECT_EQ(module.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 05 00 00 00");
    EXPECT_EQ(module.ask("605 40 03 10 05 00 00 00 00"), "585 43 03 10 05 00 FF 0A 00");
  }
}

// shows 003.80, 003.81
TEST(Manual003, RecordsTheLastFiveEmergenciesNewestFirst) {
  DigitalOutputs module;
  module.ask(bench::start);
  module.node.emergency(0x5000, ErrorRegister::manufacturer, {2});
  module.pass(0s);
  module.node.emergency_over(ErrorRegister::manufacturer);
  module.pass(0s);
  EXPECT_EQ(module.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 02 00 00 00");
  for (int i = 0; i < 2; ++i) {
    module.ask("205 12");
    module.ask("205 12 34");
  }
  EXPECT_EQ(module.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 05 00 00 00");
  EXPECT_EQ(module.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 10 82 09 00");
  EXPECT_EQ(module.ask("605 40 03 10 04 00 00 00 00"), "585 43 03 10 04 10 82 09 00");
  EXPECT_EQ(module.ask("605 40 03 10 05 00 00 00 00"), "585 43 03 10 05 00 00 00 00");
  EXPECT_EQ(module.ask("605 2F 03 10 00 00 00 00 00"), "585 80 03 10 00 02 00 01 06");
}

// shows 003.88
TEST(Manual003, HasErrorModesAndErrorValuesOfItsOutputs) {
  constexpr manual::Entry digital[] = {
      {0x6206, 0, 1, ro, 2}, {0x6206, 1, 1, rw, 0xFF}, {0x6207, 0, 1, ro, 2}, {0x6207, 2, 1, rw, 0}};
  constexpr manual::Entry analog[] = {
      {0x6443, 0, 1, ro, 4}, {0x6443, 1, 1, rw, 1}, {0x6444, 0, 1, ro, 4}, {0x6444, 4, 4, rw, 0}};
  DigitalOutputs digital_outputs;
  manual::expect_entries(digital_outputs, digital);
  AnalogOutputs analog_outputs;
  manual::expect_entries(analog_outputs, analog);
}

}  // namespace
