/// Manual 002, the servo drive CPD as node 5: object dictionary, SDO and COB-IDs.
#include <gtest/gtest.h>

#include <cpd/device.hpp>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
namespace od = cpd::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpd::Device>;

constexpr std::uint32_t no_object = 0x0602'0000;
constexpr std::uint32_t no_sub_index = 0x0609'0011;

// Object dictionary

// shows 002.3, 002.68, 002.69, 002.71, 002.118, 002.120, 002.123, 002.125, 002.129..002.134, 002.138, 002.139
// shows 002.142, 002.196, 002.389
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
// shows 002.163..002.168, 002.171..002.173, 002.228, 002.553
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

// shows 002.126, 002.127, 002.163, 002.169, 002.170, 002.195, 002.218, 002.507, 002.514, 002.521
TEST(Manual002, HasNotWhatIsOnlyNamed) {
  constexpr Missing missing[] = {
      {0x1006, 0, no_object},    {0x1007, 0, no_object},    {0x100E, 0, no_object},    {0x6404, 0, no_object},
      {0x6410, 0, no_object},    {0x1003, 6, no_sub_index}, {0x1603, 5, no_sub_index}, {0x1A03, 5, no_sub_index},
      {0x1404, 0, no_object},    {0x1804, 0, no_object},    {0x1800, 4, no_sub_index}, {0x1801, 4, no_sub_index},
      {0x1802, 4, no_sub_index}, {0x1803, 4, no_sub_index}, {0x1280, 0, no_object},
  };
  Drive drive;
  for (const auto& [index, sub_index, code] : missing) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, sub_index, 0)), refused(index, sub_index, code));
  }
}

// shows 002.58, 002.243
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

// shows 002.6..002.8, 002.10, 002.11, 002.220, 002.222
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

// shows 002.27, 002.325, 002.454, 002.460
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

// shows 002.40, 002.41, 002.124, 002.215, 002.236, 002.243
TEST(Manual002, ConsumesSyncAtTheCobIdOf1005h) {
  Drive drive;
  write(drive, 0x1800, 2, 1, 1);
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 80"), "585 60 05 10 00 00 00 00 00");
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("0A0"), "185 00 00");
}

// shows 002.42, 002.401
TEST(Manual002, KeepsTheUpperBitsOf1005h) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 A0"), "585 60 05 10 00 00 00 00 00");  // 29 bits
  EXPECT_EQ(drive.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 A0 00 00 80");
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 A0 00 00 80");
}

/// CiA 301, 7.5.2.5: a device that does not produce SYNC rejects bit 30, even though this one keeps the upper bits.
// shows 002.124, 002.400
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

// shows 002.36, 002.215
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

// shows 002.44, 002.75, 002.145, 002.146, 002.211, 002.215
TEST(Manual002, ChangesBit31AndTheFunctionCodeOfAPdo) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 01 18 01 FF 03 00 2C"), "585 60 01 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 01 18 01 00 00 00 00"), "585 43 01 18 01 85 03 00 40");
  EXPECT_EQ(drive.ask("605 23 02 14 01 05 04 00 00"), "585 60 02 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 02 14 01 85 06 00 80"), "585 60 02 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 02 14 01 85 06 00 00"), "585 60 02 14 01 00 00 00 00");
  drive.ask(bench::start);
  drive.ask("405 0F 00 E8 03 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), 0);
  drive.ask("685 0F 00 E8 03 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), 1000);
}

// shows 002.218, 002.219
TEST(Manual002, HasSdosWithHigherCanIdsThanPdos) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 00 12 01 00 00 00 00"), "585 43 00 12 01 05 06 00 00");
  EXPECT_EQ(drive.ask("605 40 00 12 02 00 00 00 00"), "585 43 00 12 02 85 05 00 00");
  constexpr std::uint16_t pdos[] = {0x1400, 0x1401, 0x1402, 0x1403, 0x1800, 0x1801, 0x1802, 0x1803};
  for (const std::uint16_t index : pdos) {
    const canopen::Frame answer = bench::frame(drive.ask(manual::sdo("605", 0x40, index, 1, 0)));
    EXPECT_LT((answer.data[4] | answer.data[5] << 8) & 0x7FF, 0x585);
  }
}

}  // namespace
