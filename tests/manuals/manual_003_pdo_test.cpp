/// Manual 003, the CAN-2000C modules as node 5: parameters and transmission of PDOs.
#include <gtest/gtest.h>

#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>

#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::taken;
using manual::write;
using namespace std::chrono_literals;

using AnalogInputs = bench::Bench<can_2017c::Device>;
using AnalogOutputs = bench::Bench<can_2024c::Device>;
using DigitalInputs = bench::Bench<can_2053c::Device>;
using DigitalOutputs = bench::Bench<can_2057c::Device>;

using Input = can_2053c::od::read_input_8_bit<1>;
using Output = can_2057c::od::write_output_8_bit<1>;

constexpr std::uint32_t not_valid = 0x8000'0000;
constexpr std::uint32_t invalid_value = 0x0609'0030;

// PDO parameters

// shows 003.33, 003.34, 003.152
TEST(Manual003, ChangesACobIdWhileThePdoIsNotValid) {
  DigitalOutputs module;
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 00"), "585 80 00 14 01 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 20"), "585 80 00 14 01 30 00 09 06");  // 29 bits
  EXPECT_EQ(module.ask("605 23 00 14 01 22 0A 00 00"), "585 80 00 14 01 30 00 09 06");  // bit 11
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 00"), "585 60 00 14 01 00 00 00 00");
  module.ask(bench::start);
  module.ask("205 12 34");
  EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0);
  module.ask("222 12 34");
  EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0x12);
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 80"), "585 60 00 14 01 00 00 00 00");
  module.ask("222 56 78");
  EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0x12);
}

// shows 003.33, 003.62, 003.63, 003.161
TEST(Manual003, AnswersRemoteFramesWhereBit30Allows) {
  DigitalInputs module;
  EXPECT_EQ(module.ask(bench::start), "185 00 00");
  EXPECT_EQ(module.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(module.ask("605 23 00 18 01 85 01 00 80"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 00 18 01 85 01 00 40").substr(0, 27), "585 60 00 18 01 00 00 00 00");
  module.pass(0s);
  EXPECT_EQ(module.ask("185 R 0"), "");
}

// shows 003.141
TEST(Manual003, RefusesTheCanIdsThatCiA301Reserves) {
  DigitalOutputs module;
  for (const std::uint32_t can_id : {0x000u, 0x001u, 0x101u, 0x180u, 0x581u, 0x5FFu, 0x601u, 0x67Fu, 0x6E0u, 0x6FFu,
                                     0x701u, 0x77Fu, 0x780u, 0x7FFu}) {
    EXPECT_EQ(write(module, 0x1404, 1, 4, can_id), refused(0x1404, 1, invalid_value)) << can_id;
  }
  for (const std::uint32_t can_id : {0x181u, 0x580u, 0x600u, 0x680u, 0x6DFu}) {
    EXPECT_EQ(write(module, 0x1404, 1, 4, can_id), taken(0x1404, 1)) << can_id;
    write(module, 0x1404, 1, 4, not_valid | can_id);
  }
}

// shows 003.35
TEST(Manual003, RefusesTheCanIdsOfSyncEmcyAndTimeForPdos) {
  DigitalOutputs module;
  for (const std::uint32_t can_id : {0x080u, 0x081u, 0x0FFu, 0x100u}) {
    EXPECT_EQ(write(module, 0x1404, 1, 4, can_id), refused(0x1404, 1, invalid_value)) << can_id;
  }
}

// shows 003.46
TEST(Manual003, RefusesReservedTransmissionTypes) {
  DigitalInputs module;
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool synchronous_or_event = type <= 240 || type >= 254;
    EXPECT_EQ(write(module, 0x1800, 2, 1, type),
              synchronous_or_event || type >= 252 ? taken(0x1800, 2) : refused(0x1800, 2, invalid_value))
        << type;
    EXPECT_EQ(write(module, 0x1400, 2, 1, type),
              synchronous_or_event ? taken(0x1400, 2) : refused(0x1400, 2, invalid_value))
        << type;
  }
}

// shows 003.54
TEST(Manual003, TakesMappingEntriesWhileThereAreNone) {
  AnalogInputs module;
  EXPECT_EQ(module.ask("605 23 01 1A 01 10 08 01 64"), "585 80 01 1A 01 00 00 01 06");
  EXPECT_EQ(module.ask("605 2F 01 1A 00 00 00 00 00"), "585 60 01 1A 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 01 1A 01 10 08 01 64"), "585 60 01 1A 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 2F 01 1A 00 01 00 00 00"), "585 60 01 1A 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 01 1A 01 00 00 00 00"), "585 43 01 1A 01 10 08 01 64");
}

struct Mapping {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t value;
};

template <class Module>
void expect_mapping(Module& module, std::initializer_list<Mapping> mapping) {
  for (const auto& [index, sub_index, value] : mapping) {
    const unsigned command = sub_index == 0 ? 0x4F : 0x43;
    EXPECT_EQ(module.ask(manual::sdo("605", 0x40, index, sub_index, 0)),
              manual::sdo("585", command, index, sub_index, value));
  }
}

// shows 003.58, 003.61, 003.123
TEST(Manual003, MapsDigitalChannelsToPdo1AndAnalogOnesToThoseAfterIt) {
  DigitalOutputs digital_outputs;
  expect_mapping(digital_outputs, {{0x1600, 0, 2},
                                   {0x1600, 1, 0x62000108},
                                   {0x1600, 2, 0x62000208},
                                   {0x1601, 0, 0},
                                   {0x1A00, 0, 0},
                                   {0x1A01, 0, 0}});
  DigitalInputs digital_inputs;
  expect_mapping(digital_inputs, {{0x1A00, 0, 2},
                                  {0x1A00, 1, 0x60000108},
                                  {0x1A00, 2, 0x60000208},
                                  {0x1A01, 0, 0},
                                  {0x1600, 0, 0},
                                  {0x1601, 0, 0}});
  AnalogOutputs analog_outputs;
  expect_mapping(analog_outputs, {{0x1600, 0, 0},
                                  {0x1601, 0, 4},
                                  {0x1601, 1, 0x64110110},
                                  {0x1601, 4, 0x64110410},
                                  {0x1602, 0, 0},
                                  {0x1A00, 0, 0}});
  AnalogInputs analog_inputs;
  expect_mapping(analog_inputs, {{0x1A00, 0, 0},
                                 {0x1A01, 0, 4},
                                 {0x1A01, 1, 0x64010110},
                                 {0x1A01, 4, 0x64010410},
                                 {0x1A02, 0, 4},
                                 {0x1A02, 1, 0x64010510},
                                 {0x1A02, 4, 0x64010810},
                                 {0x1A03, 0, 0},
                                 {0x1600, 0, 0}});
}

// PDO communication

// shows 003.12
TEST(Manual003, ServesPdosInOperationalOnly) {
  for (const char* command : {bench::enter_pre_operational, bench::stop}) {
    DigitalOutputs outputs;
    outputs.ask(command);
    EXPECT_EQ(outputs.ask("205 12 34"), "");
    EXPECT_EQ(canopen::to_raw(outputs.node.get<Output>()), 0);
    DigitalInputs inputs;
    inputs.ask(command);
    inputs.node.set<Input>(canopen::raw(1));
    EXPECT_EQ(inputs.pass(1s), "");
    EXPECT_EQ(inputs.ask("185 R 0"), "");
    EXPECT_EQ(inputs.ask(bench::start), "185 01 00");
  }
}

// shows 003.37
TEST(Manual003, TakesSynchronousRpdosAtTheNextSyncWhateverTheirNumber) {
  for (const std::uint32_t type : {0u, 1u, 3u, 240u}) {
    DigitalOutputs module;
    module.ask(bench::start);
    write(module, 0x1400, 2, 1, type);
    module.ask("205 12 34");
    EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0) << type;
    module.ask("080");
    EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0x12) << type;
  }
}

// shows 003.38
TEST(Manual003, TakesAsynchronousRpdosAtOnce) {
  for (const std::uint32_t type : {254u, 255u}) {
    DigitalOutputs module;
    module.ask(bench::start);
    write(module, 0x1400, 2, 1, type);
    module.ask("205 12 34");
    EXPECT_EQ(canopen::to_raw(module.node.get<Output>()), 0x12) << type;
  }
}

// shows 003.39, 003.40
TEST(Manual003, SendsType1AtEverySyncAndType0AfterAChange) {
  DigitalInputs module;
  module.ask(bench::start);
  write(module, 0x1800, 2, 1, 1);
  EXPECT_EQ(module.ask("080"), "185 00 00");
  EXPECT_EQ(module.ask("080"), "185 00 00");
  write(module, 0x1800, 2, 1, 0);
  module.ask("080");
  EXPECT_EQ(module.ask("080"), "");
  module.node.set<Input>(canopen::raw(1));
  EXPECT_EQ(module.pass(1s), "");
  EXPECT_EQ(module.ask("080"), "185 01 00");
  EXPECT_EQ(module.ask("080"), "");
}

// shows 003.41
TEST(Manual003, SendsTypeNAtEveryNthSync) {
  for (const std::uint32_t type : {2u, 3u, 240u}) {
    DigitalInputs module;
    module.ask(bench::start);
    write(module, 0x1800, 2, 1, type);
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t sync = 1; sync < type; ++sync) EXPECT_EQ(module.ask("080"), "") << type << ", " << sync;
      EXPECT_EQ(module.ask("080"), "185 00 00") << type;
    }
  }
}

// shows 003.44
TEST(Manual003, SendsTypes254And255AtAChangeByTheirTimerAndWhenAsked) {
  for (const std::uint32_t type : {254u, 255u}) {
    DigitalInputs module;
    write(module, 0x1800, 2, 1, type);
    module.ask(bench::start);
    module.node.set<Input>(canopen::raw(1));
    EXPECT_EQ(module.pass(1s), "185 01 00");
    EXPECT_EQ(module.ask("185 R 0"), "185 01 00");
    EXPECT_EQ(module.ask("605 2B 00 18 05 64 00 00 00"), "585 60 00 18 05 00 00 00 00");
    EXPECT_EQ(module.pass(99ms), "");
    EXPECT_EQ(module.pass(1ms), "185 01 00");
  }
}

// shows 003.48, 003.145
TEST(Manual003, CountsTheInhibitTimeInMilliseconds) {
  DigitalInputs module;
  write(module, 0x1800, 1, 4, 0x8000'0185);
  EXPECT_EQ(module.ask("605 2B 00 18 03 0A 00 00 00"), "585 60 00 18 03 00 00 00 00");
  write(module, 0x1800, 1, 4, 0x185);
  EXPECT_EQ(module.ask(bench::start), "185 00 00");
  module.node.set<Input>(canopen::raw(1));
  EXPECT_EQ(module.pass(9999us), "");
  EXPECT_EQ(module.pass(1us), "185 01 00");
}

// shows 003.59
TEST(Manual003, SdoAndPdoReachTheSameObjects) {
  DigitalOutputs outputs;
  outputs.ask(bench::start);
  outputs.ask("205 12 34");
  EXPECT_EQ(outputs.ask("605 40 00 62 02 00 00 00 00"), "585 4F 00 62 02 34 00 00 00");
  EXPECT_EQ(outputs.ask("605 2F 00 62 01 56 00 00 00"), "585 60 00 62 01 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(outputs.node.get<Output>()), 0x56);

  AnalogOutputs analog_outputs;
  analog_outputs.ask(bench::start);
  analog_outputs.ask("305 FF 3F 01 00 02 00 03 00");
  EXPECT_EQ(analog_outputs.ask("605 40 11 64 01 00 00 00 00"), "585 4B 11 64 01 FF 3F 00 00");

  DigitalInputs inputs;
  inputs.node.set<Input>(canopen::raw(0xAB));
  EXPECT_EQ(inputs.ask("605 40 00 60 01 00 00 00 00"), "585 4F 00 60 01 AB 00 00 00");
  EXPECT_EQ(inputs.ask(bench::start), "185 AB 00");

  AnalogInputs analog_inputs;
  analog_inputs.node.set<can_2017c::od::read_analogue_input_16_bit<8>>(canopen::raw(-2));
  EXPECT_EQ(analog_inputs.ask("605 40 01 64 08 00 00 00 00"), "585 4B 01 64 08 FE FF 00 00");
  EXPECT_EQ(analog_inputs.ask(bench::start), "285 00 00 00 00 00 00 00 00 | 385 00 00 00 00 00 00 FE FF");
}

// shows 003.64
TEST(Manual003, OneSyncActsOnRpdoAndTpdo) {
  DigitalOutputs outputs;
  DigitalInputs inputs;
  write(outputs, 0x1400, 2, 1, 0);
  write(inputs, 0x1800, 2, 1, 1);
  outputs.ask(bench::start);
  inputs.ask(bench::start);
  outputs.ask("205 12 34");
  EXPECT_EQ(outputs.ask("080"), "");
  EXPECT_EQ(inputs.ask("080"), "185 00 00");
  EXPECT_EQ(canopen::to_raw(outputs.node.get<Output>()), 0x12);
}

}  // namespace
