/// Manual 002: the servo drive CPD as node 5.
#include <gtest/gtest.h>

#include <algorithm>
#include <cpd/device.hpp>
#include <iterator>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using canopen::NmtState;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
namespace od = cpd::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpd::Device>;

constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr std::uint32_t read_only = 0x0601'0002;
constexpr std::uint32_t not_mappable = 0x0604'0041;
constexpr std::uint32_t no_object = 0x0602'0000;
constexpr std::uint32_t no_sub_index = 0x0609'0011;

// Object dictionary

// shows 002.3, 002.68, 002.69, 002.71, 002.118, 002.120, 002.123, 002.125, 002.129..002.134, 002.138, 002.139, 002.142
// shows 002.196
TEST(Manual002, HasTheObjectsOf94) {
  constexpr manual::Entry entries[] = {
      {0x1000, 0, 4, ro, 0x0002'0192}, {0x1001, 0, 1, ro, 0},     {0x1003, 0, 1, rw, 0},
      {0x1005, 0, 4, rw, 0x8000'0080}, {0x100C, 0, 2, rw, 0},     {0x100D, 0, 1, rw, 0},
      {0x1010, 0, 1, ro, 3},           {0x1010, 1, 4, rw, 1},     {0x1010, 2, 4, rw, 1},
      {0x1010, 3, 4, rw, 1},           {0x1011, 0, 1, ro, 3},     {0x1011, 1, 4, rw, 1},
      {0x1011, 2, 4, rw, 1},           {0x1011, 3, 4, rw, 1},     {0x1014, 0, 4, rw, 0x85},
      {0x1015, 0, 2, rw, 0},           {0x1016, 0, 1, ro, 3},     {0x1016, 1, 4, rw, 0},
      {0x1016, 3, 4, rw, 0},           {0x1017, 0, 2, rw, 0},     {0x1018, 0, 1, ro, 4},
      {0x1018, 1, 4, ro, 0x0100'002E}, {0x1018, 2, 4, ro, 0},     {0x1018, 3, 4, ro, 0},
      {0x1018, 4, 4, ro, 0},           {0x1020, 0, 1, ro, 2},     {0x1020, 1, 4, rw, 0},
      {0x1020, 2, 4, rw, 0},           {0x1029, 0, 1, ro, 1},     {0x1029, 1, 1, rw, 0},
      {0x1200, 0, 1, ro, 2},           {0x1200, 1, 4, ro, 0x605}, {0x1200, 2, 4, ro, 0x585},
      {0x1201, 0, 1, ro, 3},           {0x1201, 3, 1, rw, 1},     {0x2041, 0, 2, ro, 0},
      {0x603F, 0, 2, ro, 0},           {0x6060, 0, 1, rw, 0},     {0x6061, 0, 1, ro, 0},
      {0x607D, 0, 1, ro, 2},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
}

// shows 002.3, 002.4, 002.72, 002.73, 002.81..002.83, 002.86, 002.143, 002.144, 002.147..002.151, 002.156..002.161
// shows 002.163..002.168, 002.171..002.173
TEST(Manual002, HasEightPdosOfWhichThePairOf1IsActive) {
  constexpr manual::Entry entries[] = {
      {0x1400, 0, 1, ro, 2},           {0x1400, 1, 4, rw, 0x205},       {0x1400, 2, 1, rw, 255},
      {0x1401, 0, 1, ro, 2},           {0x1401, 1, 4, rw, 0x8000'0305}, {0x1401, 2, 1, rw, 255},
      {0x1402, 0, 1, ro, 2},           {0x1402, 1, 4, rw, 0x8000'0405}, {0x1402, 2, 1, rw, 255},
      {0x1403, 0, 1, ro, 2},           {0x1403, 1, 4, rw, 0x8000'0505}, {0x1403, 2, 1, ro, 254},
      {0x1600, 0, 1, ro, 1},           {0x1600, 1, 4, ro, 0x6040'0010}, {0x1601, 0, 1, ro, 2},
      {0x1601, 1, 4, ro, 0x6040'0010}, {0x1601, 2, 4, ro, 0x607A'0020}, {0x1601, 3, 4, ro, 0},
      {0x1601, 4, 4, ro, 0},           {0x1602, 0, 1, ro, 2},           {0x1602, 1, 4, ro, 0x6040'0010},
      {0x1602, 2, 4, ro, 0x60FF'0020}, {0x1602, 3, 4, ro, 0},           {0x1602, 4, 4, ro, 0},
      {0x1603, 0, 1, rw, 0},           {0x1603, 1, 4, rw, 0},           {0x1603, 4, 4, rw, 0},
      {0x1800, 0, 1, ro, 5},           {0x1800, 1, 4, rw, 0x185},       {0x1800, 2, 1, rw, 255},
      {0x1800, 3, 2, rw, 0},           {0x1800, 5, 2, rw, 0},           {0x1801, 0, 1, ro, 5},
      {0x1801, 1, 4, rw, 0xC000'0285}, {0x1801, 2, 1, rw, 1},           {0x1801, 3, 2, rw, 0},
      {0x1801, 5, 2, rw, 100},         {0x1802, 0, 1, ro, 5},           {0x1802, 1, 4, rw, 0xC000'0385},
      {0x1802, 2, 1, rw, 1},           {0x1802, 3, 2, rw, 0},           {0x1802, 5, 2, rw, 100},
      {0x1803, 0, 1, ro, 5},           {0x1803, 1, 4, rw, 0xC000'0485}, {0x1803, 2, 1, ro, 255},
      {0x1803, 3, 2, rw, 0},           {0x1803, 5, 2, rw, 0},           {0x1A00, 0, 1, ro, 1},
      {0x1A00, 1, 4, ro, 0x6041'0010}, {0x1A01, 0, 1, ro, 2},           {0x1A01, 1, 4, ro, 0x6041'0010},
      {0x1A01, 2, 4, ro, 0x6064'0020}, {0x1A02, 0, 1, ro, 2},           {0x1A02, 1, 4, ro, 0x6041'0010},
      {0x1A02, 2, 4, ro, 0x606C'0020}, {0x1A02, 4, 4, ro, 0},           {0x1A03, 0, 1, rw, 0},
      {0x1A03, 1, 4, rw, 0},           {0x1A03, 4, 4, rw, 0},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
}

struct Missing {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t code;
};

// shows 002.121, 002.126, 002.127, 002.163, 002.169, 002.170, 002.195
TEST(Manual002, HasNotWhatIsOnlyNamed) {
  constexpr Missing missing[] = {
      {0x1006, 0, no_object}, {0x1007, 0, no_object},    {0x100E, 0, no_object},    {0x6404, 0, no_object},
      {0x6410, 0, no_object}, {0x1003, 2, no_sub_index}, {0x1603, 5, no_sub_index}, {0x1A03, 5, no_sub_index},
      {0x1404, 0, no_object}, {0x1804, 0, no_object},    {0x1800, 4, no_sub_index}, {0x1803, 4, no_sub_index},
  };
  Drive drive;
  for (const auto& [index, sub_index, code] : missing) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, sub_index, 0)), refused(index, sub_index, code));
  }
}

// shows 002.58
TEST(Manual002, TakesGuardTimesAndErrorBehaviour) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 0C 10 00 E8 03 00 00"), "585 60 0C 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 0C 10 00 00 00 00 00"), "585 4B 0C 10 00 E8 03 00 00");
  EXPECT_EQ(drive.ask("605 2F 0D 10 00 03 00 00 00"), "585 60 0D 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 0D 10 00 00 00 00 00"), "585 4F 0D 10 00 03 00 00 00");
}

// shows 002.140
TEST(Manual002, TakesErrorBehaviour0To2AndTheManufacturers) {
  Drive drive;
  for (std::uint32_t value = 0; value <= 255; ++value) {
    const bool reserved = value > 2 && value < 128;
    EXPECT_EQ(write(drive, 0x1029, 1, 1, value), reserved ? refused(0x1029, 1, 0x0609'0030) : taken(0x1029, 1));
  }
}

// SDO

// shows 002.6, 002.7, 002.8, 002.10, 002.11
TEST(Manual002, TransfersOneToFourBytesInFramesOfEight) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 00 10 00"), "");
  EXPECT_EQ(drive.ask("605 2F 60 60 00 03 AA BB CC"), "585 60 60 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 60 60 00 AA BB CC DD"), "585 4F 60 60 00 03 00 00 00");
  EXPECT_EQ(drive.ask("605 2B 29 30 04 34 12 BB CC"), "585 60 29 30 04 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 29 30 04 00 00 00 00"), "585 4B 29 30 04 34 12 00 00");
  EXPECT_EQ(drive.ask("605 23 83 60 00 78 56 34 12"), "585 60 83 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 83 60 00 00 00 00 00"), "585 43 83 60 00 78 56 34 12");
}

// shows 002.12, 002.118
TEST(Manual002, SendsEightCharactersInSegments) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 08 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 00 43 50 44 73 65 72 76");
  EXPECT_EQ(drive.ask("605 70 00 00 00 00 00 00 00"), "585 1D 6F 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 09 10 00 00 00 00 00"), "585 41 09 10 00 08 00 00 00");
  EXPECT_EQ(drive.ask("605 40 0A 10 00 00 00 00 00"), "585 41 0A 10 00 08 00 00 00");
}

// shows 002.13
TEST(Manual002, AbortsASegmentWithTheSameToggleBit) {
  Drive drive;
  drive.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 70 00 00 00 00 00 00 00"), "585 80 08 10 00 00 00 03 05");
}

// shows 002.24, 002.25
TEST(Manual002, RefusesWrongLengths) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 17 10 00 00 00 00 00"), "585 80 17 10 00 12 00 07 06");
  EXPECT_EQ(drive.ask("605 2F 17 10 00 00 00 00 00"), "585 80 17 10 00 13 00 07 06");
  drive.ask("605 21 83 60 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 0B A2 00 00 00 00 00 00"), "585 80 83 60 00 10 00 07 06");
}

// shows 002.27
TEST(Manual002, RefusesValuesOutsideTheirRange) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2F 01 12 03 80 00 00 00"), "585 80 01 12 03 31 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 01 12 03 00 00 00 00"), "585 80 01 12 03 32 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 00 14 02 F1 00 00 00"), "585 80 00 14 02 30 00 09 06");
}

// shows 002.70
TEST(Manual002, HasASecondSdoServer) {
  Drive drive;
  EXPECT_EQ(drive.ask("641 40 00 10 00 00 00 00 00"), "");
  EXPECT_EQ(drive.ask("605 23 01 12 01 41 06 00 00"), "585 80 01 12 01 30 00 09 06");  // restricted
  EXPECT_EQ(drive.ask("605 23 01 12 01 41 05 00 00"), "585 60 01 12 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 01 12 02 C1 04 00 00"), "585 60 01 12 02 00 00 00 00");
  EXPECT_EQ(drive.ask("605 2F 01 12 03 7F 00 00 00"), "585 60 01 12 03 00 00 00 00");
  EXPECT_EQ(drive.ask("541 40 01 12 03 00 00 00 00"), "4C1 4F 01 12 03 7F 00 00 00");
  EXPECT_EQ(drive.ask("605 40 01 12 01 00 00 00 00"), "585 43 01 12 01 41 05 00 00");
}

// COB-IDs

// shows 002.40, 002.41, 002.124
TEST(Manual002, ConsumesSyncAtTheCobIdOf1005h) {
  Drive drive;
  write(drive, 0x1800, 2, 1, 1);
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 80"), "585 60 05 10 00 00 00 00 00");
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("0A0"), "185 00 00");
}

// shows 002.42
TEST(Manual002, KeepsTheUpperBitsOf1005h) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 A0 00 00 80");
}

/// CiA 301, 7.5.2.5: a device that does not produce SYNC rejects bit 30, even though this one keeps the upper bits.
TEST(Manual002, RefusesToProduceSync) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 80 00 00 80");
}

/// 180h is restricted (CiA 301, 7.3.5): the device would turn it into 185h, the CAN-ID of TPDO 1.
TEST(Manual002, RefusesARestrictedCanIdIn1014hWhateverItKeepsOfIt) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 14 10 00 80 01 00 00"), "585 80 14 10 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 23 14 10 00 00 06 00 00"), "585 80 14 10 00 30 00 09 06");  // 605h
  EXPECT_EQ(drive.ask("605 40 14 10 00 00 00 00 00"), "585 43 14 10 00 85 00 00 00");
}

// shows 002.36
TEST(Manual002, SendsEmcyWithTheFunctionCodeOf1014h) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 14 10 00 85 06 00 00"), "585 60 14 10 00 00 00 00 00");
  drive.node.emergency(0x2310, ErrorRegister::current);
  EXPECT_EQ(drive.pass(0s), "685 10 23 03 00 00 00 00 00");
}

// shows 002.43
TEST(Manual002, KeepsTheNodeIdAndTheUpperBitsOf1014h) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 14 10 00 86 06 00 80"), "585 60 14 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 14 10 00 00 00 00 00"), "585 43 14 10 00 85 06 00 00");
}

// shows 002.44, 002.75, 002.145, 002.146
TEST(Manual002, ChangesBit31AndTheFunctionCodeOfAPdo) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 01 18 01 FF 03 00 2C"), "585 60 01 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 01 18 01 00 00 00 00"), "585 43 01 18 01 85 03 00 40");
  EXPECT_EQ(drive.ask("605 23 02 14 01 05 04 00 00"), "585 60 02 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 02 14 01 85 06 00 80"), "585 60 02 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 02 14 01 85 06 00 00"), "585 60 02 14 01 00 00 00 00");
  drive.ask(bench::start);
  drive.ask("405 0F 00 E8 03 00 00");
  EXPECT_EQ(drive.node.get<od::target_velocity>(), 0);
  drive.ask("685 0F 00 E8 03 00 00");
  EXPECT_EQ(drive.node.get<od::target_velocity>(), 1000);
}

// PDO

// shows 002.52, 002.76, 002.100
TEST(Manual002, EvaluatesRpdo1AtOnce) {
  Drive drive;
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0);
  drive.ask(bench::start);
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F);
}

// shows 002.77, 002.78, 002.84
TEST(Manual002, Rpdo2And3CarryTargetsOnceTheyAreEnabled) {
  Drive drive;
  drive.ask(bench::start);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(drive.node.get<od::target_position>(), 0);
  write(drive, 0x1401, 1, 4, 0x305);
  write(drive, 0x1402, 1, 4, 0x405);
  drive.ask("305 0F 00 01 00 00 00");
  EXPECT_EQ(drive.node.get<od::target_position>(), 1);
  drive.ask("405 1F 00 FE FF FF FF");
  EXPECT_EQ(drive.node.get<od::target_velocity>(), -2);
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x1F);
  EXPECT_EQ(drive.ask("305 0F 00 01 00 00"), "085 10 82 11 00 00 00 00 00");
}

// shows 002.80, 002.84
TEST(Manual002, SendsTpdo1AfterTheStartAndAtEveryChange) {
  Drive drive;
  drive.node.set<od::statusword>(0x6631);
  EXPECT_EQ(drive.ask(bench::start), "185 31 66");
  drive.node.set<od::statusword>(0x4637);
  EXPECT_EQ(drive.pass(1s), "185 37 46");
}

// shows 002.81, 002.82, 002.149, 002.150
TEST(Manual002, SendsTpdo2And3AtEachSyncOnceTheyAreEnabled) {
  Drive drive;
  drive.node.set<od::statusword>(0x4637);
  drive.node.set<od::position_actual_value>(30000);
  drive.node.set<od::velocity_actual_value>(-1);
  EXPECT_EQ(drive.ask(bench::start), "185 37 46");
  EXPECT_EQ(drive.ask("080"), "");
  write(drive, 0x1801, 1, 4, 0x285);
  write(drive, 0x1802, 1, 4, 0x385);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("080"), "285 37 46 30 75 00 00 | 385 37 46 FF FF FF FF");
  EXPECT_EQ(drive.ask("080"), "285 37 46 30 75 00 00 | 385 37 46 FF FF FF FF");
}

TEST(Manual002, HasAStaticMappingOfPdo1To3) {
  constexpr std::uint16_t mappings[] = {0x1600, 0x1601, 0x1602, 0x1A00, 0x1A01, 0x1A02};
  Drive drive;
  for (const std::uint16_t index : mappings) {
    EXPECT_EQ(write(drive, index, 0, 1, 0), refused(index, 0, read_only));
    EXPECT_EQ(write(drive, index, 1, 4, 0), refused(index, 1, read_only));
  }
}

constexpr std::uint32_t mappable_in_tpdos[] = {0x3008'0110, 0x3009'0110, 0x3009'0510, 0x301C'0410, 0x301F'0220,
                                               0x6041'0010, 0x6061'0008, 0x6064'0020, 0x606C'0020};
constexpr std::uint32_t mappable_in_rpdos[] = {0x301B'0910, 0x3020'0410, 0x3021'0410, 0x3026'0320, 0x3026'0420,
                                               0x6040'0010, 0x607A'0020, 0x6081'0020, 0x60FF'0020};

// shows 002.21, 002.85, 002.89..002.91
TEST(Manual002, MapsTheObjectsOf334AndNoOther) {
  Drive drive;
  drive.node.entries().dictionary().for_each_entry(
      [&](std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word) {
        const auto bits = static_cast<std::uint32_t>(canopen::entry::wire_bytes(word) * 8);
        const std::uint32_t entry = (canopen::object_key(index, sub_index) << 8) | bits;
        const bool in_tpdos = std::ranges::find(mappable_in_tpdos, entry) != std::end(mappable_in_tpdos);
        const bool in_rpdos = std::ranges::find(mappable_in_rpdos, entry) != std::end(mappable_in_rpdos);
        EXPECT_EQ(write(drive, 0x1A03, 1, 4, entry), in_tpdos ? taken(0x1A03, 1) : refused(0x1A03, 1, not_mappable));
        EXPECT_EQ(write(drive, 0x1603, 1, 4, entry), in_rpdos ? taken(0x1603, 1) : refused(0x1603, 1, not_mappable));
      });
  for (const std::uint32_t entry : mappable_in_tpdos) EXPECT_EQ(write(drive, 0x1A03, 1, 4, entry), taken(0x1A03, 1));
  for (const std::uint32_t entry : mappable_in_rpdos) EXPECT_EQ(write(drive, 0x1603, 1, 4, entry), taken(0x1603, 1));
}

// shows 002.22, 002.79, 002.91
TEST(Manual002, MapsNoMoreThanEightBytes) {
  Drive drive;
  write(drive, 0x1603, 1, 4, 0x607A'0020);
  write(drive, 0x1603, 2, 4, 0x60FF'0020);
  write(drive, 0x1603, 3, 4, 0x6040'0010);
  EXPECT_EQ(drive.ask("605 2F 03 16 00 03 00 00 00"), "585 80 03 16 00 42 00 04 06");
  EXPECT_EQ(drive.ask("605 2F 03 16 00 02 00 00 00"), "585 60 03 16 00 00 00 00 00");
}

// shows 002.92
TEST(Manual002, KeepsTheInhibitTime) {
  Drive drive;
  write(drive, 0x1800, 1, 4, 0x8000'0185);
  EXPECT_EQ(drive.ask("605 2B 00 18 03 64 00 00 00"), "585 60 00 18 03 00 00 00 00");  // 10 ms
  write(drive, 0x1800, 1, 4, 0x185);
  EXPECT_EQ(drive.ask(bench::start), "185 00 00");
  drive.node.set<od::statusword>(1);
  EXPECT_EQ(drive.pass(9999us), "");
  EXPECT_EQ(drive.pass(1us), "185 01 00");
}

// shows 002.93
TEST(Manual002, SendsAnEventControlledTpdoEachTimeItsTimerExpires) {
  Drive drive;
  write(drive, 0x1800, 5, 2, 100);
  EXPECT_EQ(drive.ask(bench::start), "185 00 00");
  EXPECT_EQ(drive.pass(99ms), "");
  EXPECT_EQ(drive.pass(1ms), "185 00 00");
  EXPECT_EQ(drive.pass(100ms), "185 00 00");
}

// shows 002.94, 002.153, 002.154
TEST(Manual002, HasTheTransmissionTypesOf9421) {
  Drive drive;
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool reserved = type >= 241 && type <= 251;
    EXPECT_EQ(write(drive, 0x1800, 2, 1, type), reserved ? refused(0x1800, 2, invalid_value) : taken(0x1800, 2));
  }
  write(drive, 0x1800, 2, 1, 0);
  drive.ask(bench::start);
  drive.ask("080");
  EXPECT_EQ(drive.ask("080"), "");
  drive.node.set<od::statusword>(1);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("080"), "185 01 00");
  write(drive, 0x1800, 2, 1, 2);
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("080"), "185 01 00");
}

// shows 002.94, 002.97
TEST(Manual002, UpdatesType252AtSyncAndType253WhenAsked) {
  Drive drive;
  drive.ask(bench::start);
  write(drive, 0x1800, 2, 1, 252);
  drive.node.set<od::statusword>(1);
  EXPECT_EQ(drive.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("185 R 0"), "185 01 00");
  write(drive, 0x1800, 2, 1, 253);
  drive.node.set<od::statusword>(2);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("185 R 0"), "185 02 00");
}

// shows 002.95, 002.96
TEST(Manual002, TakesSynchronousRpdosAtTheNextSyncWhateverTheirNumber) {
  for (const std::uint32_t type : {0u, 1u, 3u, 240u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0) << type;
    drive.ask("080");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F) << type;
  }
}

// shows 002.101
TEST(Manual002, AnswersRemoteFramesForTpdo1Only) {
  Drive drive;
  write(drive, 0x1801, 1, 4, 0x285);
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("185 R 0"), "185 00 00");
  EXPECT_EQ(drive.ask("285 R 0"), "");
}

// shows 002.102, 002.173
TEST(Manual002, HasFixedTransmissionTypesOfPdo4) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2F 03 14 02 FF 00 00 00"), "585 80 03 14 02 02 00 01 06");
  EXPECT_EQ(drive.ask("605 2F 03 18 02 FE 00 00 00"), "585 80 03 18 02 02 00 01 06");
}

// Error control

// shows 002.54, 002.55, 002.199
TEST(Manual002, AnswersEachGuardingRequestWithItsStateAndAToggleBit) {
  Drive drive;
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
  EXPECT_EQ(drive.pass(10s), "");
  EXPECT_EQ(drive.ask("705 R 1"), "705 FF");
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  drive.ask(bench::stop);
  EXPECT_EQ(drive.ask("705 R 1"), "705 84");
  EXPECT_EQ(drive.ask("705 R 1"), "705 04");
  drive.ask(bench::reset_communication);
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
}

// shows 002.56, 002.197
TEST(Manual002, TellsThatTheMasterIsMissing) {
  Drive drive;
  write(drive, 0x100C, 0, 2, 200);
  write(drive, 0x100D, 0, 1, 2);
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  EXPECT_EQ(drive.pass(399'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
  EXPECT_EQ(drive.node.state(), NmtState::pre_operational);
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 11 00 00 00");
  write(drive, 0x100D, 0, 1, 0);
  drive.pass(0s);
  drive.ask("705 R 1");
  EXPECT_EQ(drive.pass(10s), "");
}

// shows 002.98
TEST(Manual002, IsNotGuardedDuringItsInitialisation) {
  bench::RecordingBus bus;
  canopen::Node<cpd::Device, bench::RecordingBus> node{bus, canopen::NodeId{5}};
  node.on_frame(bench::frame("705 R 1"), {});
  EXPECT_EQ(bus.take(), "");
  node.start({});
  EXPECT_EQ(bus.take(), "705 00");
  node.on_frame(bench::frame("705 R 1"), {});
  EXPECT_EQ(bus.take(), "705 7F");
}

// shows 002.62
TEST(Manual002, IsNotGuardedWhileItHasAHeartbeat) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 17 10 00 E8 03 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(drive.ask("705 R 1"), "");
  EXPECT_EQ(drive.pass(1s), "705 7F");
}

// shows 002.63, 002.64, 002.137
TEST(Manual002, WatchesTheHeartbeatOfTheNodeIn1016h) {
  Drive drive;
  write(drive, 0x1016, 1, 4, 0x0001'00C8);  // node 1, 200 ms
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199ms), "");
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
  Drive unused;
  write(unused, 0x1016, 1, 4, 0x0001'0000);
  EXPECT_EQ(unused.ask("701 05"), "");
  EXPECT_EQ(unused.pass(10s), "");
}

// shows 002.65
TEST(Manual002, GoesWhere1029hSaysWhenErrorControlFails) {
  struct Row {
    std::uint32_t behaviour;
    const char* command;
    NmtState after;
  };
  constexpr Row rows[] = {
      {0, bench::start, NmtState::pre_operational},
      {0, bench::stop, NmtState::stopped},
      {1, bench::start, NmtState::operational},
      {2, bench::start, NmtState::stopped},
      {2, bench::enter_pre_operational, NmtState::stopped},
  };
  for (const auto& [behaviour, command, after] : rows) {
    Drive drive;
    if (behaviour != 0) write(drive, 0x1029, 1, 1, behaviour);
    write(drive, 0x1016, 1, 4, 0x0001'00C8);
    drive.ask(command);
    drive.ask("701 05");
    drive.pass(200ms);
    EXPECT_EQ(drive.node.state(), after) << behaviour << ", " << command;
  }
}

// EMCY

TEST(Manual002, CarriesTheErrorAndItsObjectInAnEmcy) {
  Drive drive;
  drive.node.emergency(0x8611, ErrorRegister::device_profile, {0x20, 0xA3, 0x65, 0x60, 0x00});
  EXPECT_EQ(drive.pass(0s), "085 11 86 21 20 A3 65 60 00");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 21 00 00 00");
}

// shows 002.33
TEST(Manual002, TellsTheKindOfAnErrorInTheErrorRegister) {
  constexpr std::uint8_t bits[] = {0x10, 0x20, 0x80};
  for (const std::uint8_t bit : bits) {
    Drive drive;
    drive.node.emergency(0x1000, static_cast<ErrorRegister>(bit));
    drive.pass(0s);
    EXPECT_EQ(drive.node.get<od::error_register>(), bit | 1);
  }
}

// shows 002.30, 002.31, 002.121, 002.122, 002.189
TEST(Manual002, KeepsTheLastErrorUntil0IsWritten) {
  Drive drive;
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.pass(0s);
  drive.node.emergency(0x3210, ErrorRegister::voltage);
  drive.pass(0s);
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 01 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 10 32 00 00");
  EXPECT_EQ(drive.ask("605 2F 03 10 00 00 00 00 00"), "585 60 03 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
}

// shows 002.37
TEST(Manual002, KeepsTheInhibitTimeOfEmcy) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 15 10 00 64 00 00 00"), "585 60 15 10 00 00 00 00 00");  // 10 ms
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.node.emergency(0x3210, ErrorRegister::voltage);
  EXPECT_EQ(drive.pass(9999us), "085 10 23 03 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1us), "085 10 32 07 00 00 00 00 00");
}

}  // namespace
