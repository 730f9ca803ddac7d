/// Manual 003: the four CAN-2000C modules of its worked example, each as node 5.
#include <gtest/gtest.h>

#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
using namespace std::chrono_literals;

using AnalogInputs = bench::Bench<can_2017c::Device>;
using AnalogOutputs = bench::Bench<can_2024c::Device>;
using DigitalInputs = bench::Bench<can_2053c::Device>;
using DigitalOutputs = bench::Bench<can_2057c::Device>;

using Input = can_2053c::od::read_input_8_bit<1>;
using Output = can_2057c::od::write_output_8_bit<1>;

template <class Module>
struct EveryModule : testing::Test {
  Module module;
};

using Modules = testing::Types<AnalogInputs, AnalogOutputs, DigitalInputs, DigitalOutputs>;
TYPED_TEST_SUITE(EveryModule, Modules);

constexpr std::uint32_t not_valid = 0x8000'0000;
constexpr std::uint32_t invalid_value = 0x0609'0030;

// Object dictionary

// shows 003.18, 003.28, 003.66, 003.83, 003.96
TYPED_TEST(EveryModule, HasTheGeneralObjects) {
  constexpr manual::Entry entries[] = {
      {0x1001, 0, 1, ro, 0}, {0x1003, 0, 1, ro, 0},     {0x1005, 0, 4, rw, 0x80},  {0x100C, 0, 2, rw, 0},
      {0x100D, 0, 1, rw, 0}, {0x1010, 0, 1, ro, 1},     {0x1010, 1, 4, rw, 1},     {0x1011, 0, 1, ro, 1},
      {0x1011, 1, 4, rw, 1}, {0x1014, 0, 4, rw, 0x85},  {0x1017, 0, 2, rw, 0},     {0x1018, 0, 1, ro, 4},
      {0x1200, 0, 1, ro, 2}, {0x1200, 1, 4, ro, 0x605}, {0x1200, 2, 4, ro, 0x585},
  };
  manual::expect_entries(this->module, entries);
}

// shows 003.32, 003.36, 003.96
TYPED_TEST(EveryModule, HasTenPdosOfEachDirection) {
  constexpr std::uint32_t rpdos[] = {0x205, 0x305, 0x405, 0x505};
  constexpr std::uint32_t tpdos[] = {0x185, 0x285, 0x385, 0x485};
  for (std::uint16_t i = 0; i < 10; ++i) {
    const auto rpdo = static_cast<std::uint16_t>(0x1400 + i);
    const auto tpdo = static_cast<std::uint16_t>(0x1800 + i);
    const manual::Entry entries[] = {
        {rpdo, 0, 1, ro, 2},
        {rpdo, 1, 4, rw, i < 4 ? rpdos[i] : not_valid},
        {rpdo, 2, 1, rw, 0xFF},
        {tpdo, 0, 1, ro, 5},
        {tpdo, 1, 4, rw, i < 4 ? tpdos[i] : not_valid},
        {tpdo, 2, 1, rw, 0xFF},
        {tpdo, 3, 2, rw, 0},
        {tpdo, 5, 2, rw, 0},
    };
    manual::expect_entries(this->module, entries);
  }
  EXPECT_EQ(this->module.ask("605 40 0A 14 00 00 00 00 00"), "585 80 0A 14 00 00 00 02 06");
  EXPECT_EQ(this->module.ask("605 40 0A 18 00 00 00 00 00"), "585 80 0A 18 00 00 00 02 06");
}

// shows 003.97
TYPED_TEST(EveryModule, HasNoSubIndex4InItsTpdos) {
  EXPECT_EQ(this->module.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(this->module.ask("605 2F 09 18 04 00 00 00 00"), "585 80 09 18 04 11 00 09 06");
}

// shows 003.20, 003.21, 003.95
TYPED_TEST(EveryModule, SendsItsNameInSegmentsWithA00hAtTheEnd) {
  EXPECT_EQ(this->module.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 09 00 00 00");
  EXPECT_EQ(this->module.ask("605 60 00 00 00 00 00 00 00").substr(0, 24), "585 00 43 41 4E 2D 32 30");
  const std::string last = this->module.ask("605 70 00 00 00 00 00 00 00");
  EXPECT_EQ(last.substr(0, 6), "585 1B");
  EXPECT_EQ(last.substr(9), " 00 00 00 00 00 00");
  EXPECT_EQ(this->module.ask("605 21 08 10 00 09 00 00 00"), "585 80 08 10 00 02 00 01 06");
  EXPECT_EQ(this->module.ask("605 40 09 10 00 00 00 00 00"), "585 41 09 10 00 06 00 00 00");
  EXPECT_EQ(this->module.ask("605 60 00 00 00 00 00 00 00"), "585 03 56 31 2E 30 30 00 00");
  EXPECT_EQ(this->module.ask("605 40 0A 10 00 00 00 00 00"), "585 41 0A 10 00 06 00 00 00");
}

// shows 003.23
TYPED_TEST(EveryModule, HasNoWritableEntryOfMoreThanFourBytes) {
  this->module.node.entries().dictionary().for_each_entry(
      [](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
        if ((word & canopen::entry::writable) == 0) return;
        EXPECT_GE(canopen::entry::wire_bytes(word), 1) << index << ":" << unsigned{sub_index};
        EXPECT_LE(canopen::entry::wire_bytes(word), 4) << index << ":" << unsigned{sub_index};
      });
}

// shows 003.93
TEST(Manual003, TellsItsKindInTheDeviceType) {
  EXPECT_EQ(DigitalInputs{}.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 01 00");
  EXPECT_EQ(DigitalOutputs{}.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 02 00");
  EXPECT_EQ(AnalogInputs{}.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 04 00");
  EXPECT_EQ(AnalogOutputs{}.ask("605 40 00 10 00 00 00 00 00"), "585 43 00 10 00 91 01 08 00");
}

// shows 003.92
TEST(Manual003, TakesGuardTimesOf16Bits) {
  DigitalOutputs module;
  EXPECT_EQ(module.ask("605 2B 0C 10 00 FF FF 00 00"), "585 60 0C 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 0C 10 00 00 00 00 00"), "585 4B 0C 10 00 FF FF 00 00");
  EXPECT_EQ(module.ask("605 23 0C 10 00 00 00 01 00"), "585 80 0C 10 00 12 00 07 06");
}

// SDO

// shows 003.19, 003.22, 003.24, 003.25
TEST(Manual003, TransfersUpToFourBytesExpedited) {
  DigitalOutputs module;
  EXPECT_EQ(module.ask("605 2F 00 14 02 05 AA BB CC"), "585 60 00 14 02 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 00 14 02 00 00 00 00"), "585 4F 00 14 02 05 00 00 00");
  EXPECT_EQ(module.ask("605 2B 00 18 05 34 12 BB CC"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 00 18 05 00 00 00 00"), "585 4B 00 18 05 34 12 00 00");
  EXPECT_EQ(module.ask("605 23 05 16 01 08 01 00 62"), "585 60 05 16 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 05 16 01 00 00 00 00"), "585 43 05 16 01 08 01 00 62");
}

// shows 003.30
TEST(Manual003, AbortsASegmentWithTheSameToggleBit) {
  DigitalOutputs module;
  module.ask("605 40 08 10 00 00 00 00 00");
  module.ask("605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 00 00 03 05");
}

// shows 003.31
TEST(Manual003, EndsATransferThatTheClientAborts) {
  DigitalOutputs module;
  module.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(module.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
}

// PDO parameters

// shows 003.33, 003.34
TEST(Manual003, ChangesACobIdWhileThePdoIsNotValid) {
  DigitalOutputs module;
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 00"), "585 80 00 14 01 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 20"), "585 80 00 14 01 30 00 09 06");  // 29 bits
  EXPECT_EQ(module.ask("605 23 00 14 01 22 0A 00 00"), "585 80 00 14 01 30 00 09 06");  // bit 11
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 00"), "585 60 00 14 01 00 00 00 00");
  module.ask(bench::start);
  module.ask("205 12 34");
  EXPECT_EQ(module.node.get<Output>(), 0);
  module.ask("222 12 34");
  EXPECT_EQ(module.node.get<Output>(), 0x12);
  EXPECT_EQ(module.ask("605 23 00 14 01 22 02 00 80"), "585 60 00 14 01 00 00 00 00");
  module.ask("222 56 78");
  EXPECT_EQ(module.node.get<Output>(), 0x12);
}

// shows 003.33, 003.62, 003.63
TEST(Manual003, AnswersRemoteFramesWhereBit30Allows) {
  DigitalInputs module;
  EXPECT_EQ(module.ask(bench::start), "185 00 00");
  EXPECT_EQ(module.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(module.ask("605 23 00 18 01 85 01 00 80"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(module.ask("605 23 00 18 01 85 01 00 40").substr(0, 27), "585 60 00 18 01 00 00 00 00");
  module.pass(0s);
  EXPECT_EQ(module.ask("185 R 0"), "");
}

TEST(Manual003, RefusesTheCanIdsThatCiA301Reserves) {
  DigitalOutputs module;
  for (const std::uint32_t can_id :
       {0x000u, 0x001u, 0x101u, 0x180u, 0x581u, 0x5FFu, 0x601u, 0x67Fu, 0x6E0u, 0x701u, 0x77Fu, 0x780u, 0x7FFu}) {
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

// shows 003.58, 003.61
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
    EXPECT_EQ(outputs.node.get<Output>(), 0);
    DigitalInputs inputs;
    inputs.ask(command);
    inputs.node.set<Input>(1);
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
    EXPECT_EQ(module.node.get<Output>(), 0) << type;
    module.ask("080");
    EXPECT_EQ(module.node.get<Output>(), 0x12) << type;
  }
}

// shows 003.38
TEST(Manual003, TakesAsynchronousRpdosAtOnce) {
  for (const std::uint32_t type : {254u, 255u}) {
    DigitalOutputs module;
    module.ask(bench::start);
    write(module, 0x1400, 2, 1, type);
    module.ask("205 12 34");
    EXPECT_EQ(module.node.get<Output>(), 0x12) << type;
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
  module.node.set<Input>(1);
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
    module.node.set<Input>(1);
    EXPECT_EQ(module.pass(1s), "185 01 00");
    EXPECT_EQ(module.ask("185 R 0"), "185 01 00");
    EXPECT_EQ(module.ask("605 2B 00 18 05 64 00 00 00"), "585 60 00 18 05 00 00 00 00");
    EXPECT_EQ(module.pass(99ms), "");
    EXPECT_EQ(module.pass(1ms), "185 01 00");
  }
}

// shows 003.48
TEST(Manual003, CountsTheInhibitTimeInMilliseconds) {
  DigitalInputs module;
  write(module, 0x1800, 1, 4, 0x8000'0185);
  EXPECT_EQ(module.ask("605 2B 00 18 03 0A 00 00 00"), "585 60 00 18 03 00 00 00 00");
  write(module, 0x1800, 1, 4, 0x185);
  EXPECT_EQ(module.ask(bench::start), "185 00 00");
  module.node.set<Input>(1);
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
  EXPECT_EQ(outputs.node.get<Output>(), 0x56);

  AnalogOutputs analog_outputs;
  analog_outputs.ask(bench::start);
  analog_outputs.ask("305 FF 3F 01 00 02 00 03 00");
  EXPECT_EQ(analog_outputs.ask("605 40 11 64 01 00 00 00 00"), "585 4B 11 64 01 FF 3F 00 00");

  DigitalInputs inputs;
  inputs.node.set<Input>(0xAB);
  EXPECT_EQ(inputs.ask("605 40 00 60 01 00 00 00 00"), "585 4F 00 60 01 AB 00 00 00");
  EXPECT_EQ(inputs.ask(bench::start), "185 AB 00");

  AnalogInputs analog_inputs;
  analog_inputs.node.set<can_2017c::od::read_analogue_input_16_bit<8>>(-2);
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
  EXPECT_EQ(outputs.node.get<Output>(), 0x12);
}

// Error control

// shows 003.76, 003.84..003.86
TYPED_TEST(EveryModule, MissesTheMasterAfterTheNodeLifeTime) {
  EXPECT_EQ(this->module.ask("605 40 0C 10 00 00 00 00 00"), "585 4B 0C 10 00 00 00 00 00");
  EXPECT_EQ(this->module.ask("605 40 0D 10 00 00 00 00 00"), "585 4F 0D 10 00 00 00 00 00");
  EXPECT_EQ(this->module.ask("605 2B 0C 10 00 FA 00 00 00"), "585 60 0C 10 00 00 00 00 00");  // 250 ms
  EXPECT_EQ(this->module.ask("605 2F 0D 10 00 04 00 00 00"), "585 60 0D 10 00 00 00 00 00");
  EXPECT_EQ(this->module.pass(10s), "");
  EXPECT_EQ(this->module.ask("705 R 1"), "705 7F");
  EXPECT_EQ(this->module.ask("705 R 1"), "705 FF");
  this->module.ask(bench::stop);
  EXPECT_EQ(this->module.ask("705 R 1"), "705 04");
  this->module.ask(bench::enter_pre_operational);
  EXPECT_EQ(this->module.ask("705 R 1"), "705 FF");
  EXPECT_EQ(this->module.pass(999'999us), "");
  EXPECT_EQ(this->module.pass(1us), "085 30 81 11 07 00 00 00 00");
}

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
    const std::uint8_t mode = node.template get<od::error_mode_output_8_bit<1>>();
    const std::uint8_t value = node.template get<od::error_value_output_8_bit<1>>();
    const std::uint8_t output = node.template get<Output>();
    if (lost) (void)node.template set<Output>(static_cast<std::uint8_t>((output & ~mode) | (value & mode)));
  }));
  write(module, 0x100C, 0, 2, 250);
  write(module, 0x100D, 0, 1, 4);
  write(module, 0x6206, 1, 1, 0x0F);
  write(module, 0x6207, 1, 1, 0xA5);
  module.ask(bench::start);
  module.ask("205 F0 00");
  module.ask("705 R 1");
  EXPECT_EQ(module.pass(1s).substr(0, 27), "085 30 81 11 07 00 00 00 00");
  EXPECT_EQ(module.node.get<Output>(), 0xF5);
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

// shows 003.66
TEST(Manual003, ConsumesSyncAtTheCobIdOf1005h) {
  DigitalInputs module;
  write(module, 0x1800, 2, 1, 1);
  EXPECT_EQ(module.ask("605 23 05 10 00 80 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 05 10 00 80 00 00 20"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(module.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  module.ask(bench::start);
  EXPECT_EQ(module.ask("080"), "");
  EXPECT_EQ(module.ask("0A0"), "185 00 00");
}

// shows 003.68
TEST(Manual003, SendsEmcyAtTheCobIdOf1014hOrNotAtAll) {
  DigitalOutputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.ask("605 23 14 10 00 85 00 00 80"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("205 00"), "");
  module.ask("205 00 00");
  EXPECT_EQ(module.ask("605 23 14 10 00 90 00 00 00"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("205 00"), "090 10 82 11 09 00 00 00 00");
}

// shows 003.50, 003.51, 003.69, 003.78
TEST(Manual003, TellsAPdoLengthErrorOnceAndItsEnd) {
  DigitalOutputs module;
  module.ask(bench::start);
  EXPECT_EQ(module.ask("205 12"), "085 10 82 11 09 00 00 00 00");
  EXPECT_EQ(module.ask("205 12"), "");
  EXPECT_EQ(module.node.get<Output>(), 0);
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

// shows 003.82
TEST(Manual003, SendsTheEmergenciesThatItsFirmwareFinds) {
  for (const auto& [code, bits, detail, frame] : emergencies) {
    DigitalOutputs module;
    module.node.emergency(code, bits, {detail});
    EXPECT_EQ(module.pass(0s), frame);
    EXPECT_EQ(module.ask("605 40 01 10 00 00 00 00 00"),
              bits == ErrorRegister::manufacturer ? "585 4F 01 10 00 81 00 00 00" : "585 4F 01 10 00 11 00 00 00");
  }
}

// shows 003.79
TEST(Manual003, TellsThatItHasBeenAskedToReset) {
  DigitalOutputs node_reset;
  EXPECT_EQ(node_reset.ask(bench::reset_node), "085 00 FF 80 0A 00 00 00 00 | 705 00");
  DigitalOutputs communication_reset;
  EXPECT_EQ(communication_reset.ask(bench::reset_communication), "085 00 FF 80 0A 00 00 00 00 | 705 00");
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
