/// Manual 003, the CAN-2000C modules as node 5: object dictionary, SDO, and what is the same in every module.
#include <gtest/gtest.h>

#include <can_2017c/device.hpp>
#include <can_2024c/device.hpp>
#include <can_2053c/device.hpp>
#include <can_2057c/device.hpp>

#include "manual_bench.hpp"

namespace {

using manual::ro;
using manual::rw;
using namespace std::chrono_literals;

using AnalogInputs = bench::Bench<can_2017c::Device>;
using AnalogOutputs = bench::Bench<can_2024c::Device>;
using DigitalInputs = bench::Bench<can_2053c::Device>;
using DigitalOutputs = bench::Bench<can_2057c::Device>;

template <class Module>
struct EveryModule : testing::Test {
  Module module;
};

using Modules = testing::Types<AnalogInputs, AnalogOutputs, DigitalInputs, DigitalOutputs>;
TYPED_TEST_SUITE(EveryModule, Modules);

constexpr std::uint32_t not_valid = 0x8000'0000;

// Object dictionary

// shows 003.18, 003.28, 003.66, 003.83, 003.96, 003.137
TYPED_TEST(EveryModule, HasTheGeneralObjects) {
  constexpr manual::Entry entries[] = {
      {0x1001, 0, 1, ro, 0}, {0x1003, 0, 1, ro, 0},     {0x1005, 0, 4, rw, 0x80},  {0x100C, 0, 2, rw, 0},
      {0x100D, 0, 1, rw, 0}, {0x1010, 0, 1, ro, 1},     {0x1010, 1, 4, rw, 1},     {0x1011, 0, 1, ro, 1},
      {0x1011, 1, 4, rw, 1}, {0x1014, 0, 4, rw, 0x85},  {0x1017, 0, 2, rw, 0},     {0x1018, 0, 1, ro, 4},
      {0x1200, 0, 1, ro, 2}, {0x1200, 1, 4, ro, 0x605}, {0x1200, 2, 4, ro, 0x585},
  };
  manual::expect_entries(this->module, entries);
}

// The entries whose default value is "---": their type is that of the answer, and they are read-only.
// shows 003.136, 003.137
TYPED_TEST(EveryModule, HasTheGeneralObjectsWithoutADefaultValue) {
  struct Row {
    std::uint16_t index;
    std::uint8_t sub_index;
    const char* answer;  ///< command, index and sub-index
  };
  constexpr Row rows[] = {
      {0x1000, 0, "585 43 00 10 00"}, {0x1001, 0, "585 4F 01 10 00"}, {0x1008, 0, "585 41 08 10 00"},
      {0x1009, 0, "585 41 09 10 00"}, {0x100A, 0, "585 41 0A 10 00"}, {0x1018, 1, "585 43 18 10 01"},
      {0x1018, 2, "585 43 18 10 02"}, {0x1018, 3, "585 43 18 10 03"}, {0x1018, 4, "585 43 18 10 04"},
  };
  for (const auto& [index, sub_index, answer] : rows) {
    EXPECT_EQ(this->module.ask(manual::sdo("605", 0x40, index, sub_index, 0)).substr(0, 15), answer);
    EXPECT_EQ(manual::write(this->module, index, sub_index, 4, 0), manual::refused(index, sub_index, 0x0601'0002));
  }
  for (std::uint8_t error = 1; error <= 5; ++error) {
    this->module.node.emergency(0x5000, canopen::ErrorRegister::manufacturer, {2});
    this->module.pass(0s);
    EXPECT_EQ(this->module.ask(manual::sdo("605", 0x40, 0x1003, error, 0)),
              manual::sdo("585", 0x43, 0x1003, error, 0x0002'5000));
    EXPECT_EQ(manual::write(this->module, 0x1003, error, 4, 0), manual::refused(0x1003, error, 0x0601'0002));
  }
  EXPECT_EQ(this->module.ask("605 40 03 10 06 00 00 00 00"), "585 80 03 10 06 11 00 09 06");
}

// shows 003.32, 003.36, 003.96, 003.132, 003.138, 003.139, 003.181
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

// shows 003.93, 003.99
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
  EXPECT_EQ(module.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
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

}  // namespace
