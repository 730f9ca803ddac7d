/// Manual 000, the servo drive cpc TC1: object dictionary, SDO and COB-IDs.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>

#include "manual_000_bench.hpp"
#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
using manual_000::Drive;
using manual_000::start_with;
namespace od = cpc_tc1::od;
using namespace std::chrono_literals;

constexpr std::uint32_t invalid_value = 0x0609'0030;

// Object dictionary

// shows 000.6, 000.7, 000.10, 000.11, 000.21, 000.28, 000.111, 000.130, 000.135, 000.137, 000.141, 000.142
// shows 000.145, 000.155, 000.162, 000.166..000.169
TEST(Manual000, HasTheObjectsOfChapter12) {
  constexpr manual::Entry entries[] = {
      {0x1000, 0, 4, ro, 0x0042'0192}, {0x1001, 0, 1, ro, 0},    {0x1002, 0, 4, ro, 0}, {0x1003, 0, 1, rw, 0},
      {0x1005, 0, 4, rw, 0x80},        {0x1006, 0, 4, rw, 0},    {0x1010, 0, 1, ro, 6}, {0x1010, 1, 4, rw, 1},
      {0x1010, 2, 4, rw, 1},           {0x1010, 3, 4, rw, 1},    {0x1010, 4, 4, rw, 1}, {0x1010, 5, 4, rw, 1},
      {0x1010, 6, 4, rw, 1},           {0x1011, 0, 1, ro, 6},    {0x1011, 1, 4, rw, 1}, {0x1011, 2, 4, rw, 1},
      {0x1011, 3, 4, rw, 1},           {0x1011, 4, 4, rw, 1},    {0x1011, 5, 4, rw, 1}, {0x1011, 6, 4, rw, 1},
      {0x1013, 0, 4, rw, 0},           {0x1014, 0, 4, ro, 0x85}, {0x1015, 0, 2, rw, 0}, {0x1016, 0, 1, ro, 4},
      {0x1016, 1, 4, rw, 0},           {0x1016, 4, 4, rw, 0},    {0x1017, 0, 2, rw, 0}, {0x1018, 0, 1, ro, 4},
      {0x1018, 1, 4, ro, 0x3F5},       {0x1018, 2, 4, ro, 1},    {0x1018, 3, 4, ro, 1}, {0x1018, 4, 4, ro, 0},
      {0x1019, 0, 1, rw, 0},           {0x1022, 0, 1, ro, 0},    {0x1200, 0, 1, ro, 2}, {0x1200, 1, 4, ro, 0x605},
      {0x1200, 2, 4, ro, 0x585},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
}

// shows 000.10, 000.11, 000.13, 000.28, 000.75, 000.78..000.80, 000.98, 000.175
TEST(Manual000, HasFourPdosOfEachDirection) {
  constexpr manual::Entry entries[] = {
      {0x1400, 0, 1, ro, 2},           {0x1400, 1, 4, rw, 0x205},       {0x1400, 2, 1, rw, 0xFF},
      {0x1401, 0, 1, ro, 2},           {0x1401, 1, 4, rw, 0x8000'0305}, {0x1401, 2, 1, rw, 0xFF},
      {0x1402, 0, 1, ro, 2},           {0x1402, 1, 4, rw, 0x8000'0405}, {0x1402, 2, 1, rw, 0xFF},
      {0x1403, 0, 1, ro, 2},           {0x1403, 1, 4, rw, 0x8000'0505}, {0x1403, 2, 1, rw, 0xFF},
      {0x1800, 0, 1, ro, 5},           {0x1800, 1, 4, rw, 0x4000'0185}, {0x1800, 2, 1, rw, 0xFF},
      {0x1800, 3, 2, rw, 0},           {0x1800, 5, 2, rw, 100},         {0x1801, 0, 1, ro, 5},
      {0x1801, 1, 4, rw, 0x4000'0285}, {0x1801, 2, 1, rw, 0xFF},        {0x1801, 3, 2, rw, 0},
      {0x1801, 5, 2, rw, 100},         {0x1802, 0, 1, ro, 5},           {0x1802, 1, 4, rw, 0x4000'0385},
      {0x1802, 2, 1, rw, 0xFF},        {0x1802, 3, 2, rw, 0},           {0x1802, 5, 2, rw, 100},
      {0x1803, 0, 1, ro, 5},           {0x1803, 1, 4, rw, 0x4000'0485}, {0x1803, 2, 1, rw, 0xFF},
      {0x1803, 3, 2, rw, 0},           {0x1803, 5, 2, rw, 100},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
  constexpr std::uint16_t missing[] = {0x1404, 0x1604, 0x1804, 0x1A04, 0x1201};
  for (const std::uint16_t index : missing) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, 0, 0)), refused(index, 0, 0x0602'0000));
  }
}

// shows 000.87, 000.89, 000.98, 000.179
TEST(Manual000, HasTheDefaultMappingOfChapter12) {
  constexpr manual::Entry entries[] = {
      {0x1600, 0, 1, rw, 1},           {0x1600, 1, 4, rw, 0x6040'0010}, {0x1600, 2, 4, rw, 0},
      {0x1600, 3, 4, rw, 0},           {0x1600, 4, 4, rw, 0},           {0x1601, 0, 1, rw, 2},
      {0x1601, 1, 4, rw, 0x6040'0010}, {0x1601, 2, 4, rw, 0x607A'0020}, {0x1601, 3, 4, rw, 0},
      {0x1602, 0, 1, rw, 2},           {0x1602, 1, 4, rw, 0x6040'0010}, {0x1602, 2, 4, rw, 0x60FF'0020},
      {0x1602, 4, 4, rw, 0},           {0x1603, 0, 1, rw, 0},           {0x1603, 1, 4, rw, 0},
      {0x1603, 4, 4, rw, 0},           {0x1A00, 0, 1, rw, 1},           {0x1A00, 1, 4, rw, 0x6041'0010},
      {0x1A00, 2, 4, rw, 0},           {0x1A01, 0, 1, rw, 2},           {0x1A01, 1, 4, rw, 0x6041'0010},
      {0x1A01, 2, 4, rw, 0x6064'0020}, {0x1A02, 0, 1, rw, 2},           {0x1A02, 1, 4, rw, 0x6041'0010},
      {0x1A02, 2, 4, rw, 0x606C'0020}, {0x1A03, 0, 1, rw, 2},           {0x1A03, 1, 4, rw, 0x6041'0010},
      {0x1A03, 2, 4, rw, 0x606C'0020}, {0x1A03, 3, 4, rw, 0},           {0x1A03, 4, 4, rw, 0},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
}

struct IndexRange {
  std::uint16_t first;
  std::uint16_t last;
};

constexpr IndexRange missing_objects[] = {
    {0x1007, 0x1007}, {0x100C, 0x100D}, {0x1012, 0x1012}, {0x1020, 0x1020},
    {0x1023, 0x1029}, {0x1280, 0x12FF}, {0x1FA0, 0x1FCF}, {0x1FD0, 0x1FFF},
};

// shows 000.4, 000.6, 000.180, 000.181, 000.340
TEST(Manual000, HasNoObjectsOfWhatIsNotImplemented) {
  Drive drive;
  for (const auto& [first, last] : missing_objects) {
    for (std::uint16_t index = first; index <= last; ++index) {
      EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, 0, 0)), refused(index, 0, 0x0602'0000));
    }
  }
}

// shows 000.84, 000.172, 000.176, 000.324, 000.348
TEST(Manual000, RefusesEveryAccessToSubIndex4OfATpdo) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(drive.ask("605 40 00 18 06 00 00 00 00"), "585 80 00 18 06 11 00 09 06");
}

// shows 000.26, 000.55, 000.222, 000.227..000.230
TEST(Manual000, SendsItsNameWithoutA00h) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 09 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 00 54 43 31 2D 38 2F 32");
  EXPECT_EQ(drive.ask("605 70 00 00 00 00 00 00 00"), "585 1B 33 30 00 00 00 00 00");
}

// SDO

// shows 000.22, 000.23
TEST(Manual000, TransfersNumbersLowByteFirst) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 00 18 05 14 01 00 00"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 00 18 05 00 00 00 00"), "585 4B 00 18 05 14 01 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::tpdo_communication_parameter_1::event_timer>()), 276);
}

// shows 000.24
TEST(Manual000, SendsNegativeNumbersInTwosComplement) {
  Drive drive;
  drive.node.set<od::velocity_actual_value>(-276);
  EXPECT_EQ(drive.ask("605 40 6C 60 00 00 00 00 00"), "585 43 6C 60 00 EC FE FF FF");
}

// shows 000.3
TEST(Manual000, HasNoBlockTransfer) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 A4 08 10 00 7F 00 00 00"), "585 80 08 10 00 01 00 04 05");
  EXPECT_EQ(drive.ask("605 C2 05 10 00 04 00 00 00"), "585 80 05 10 00 01 00 04 05");
}

// shows 000.46, 000.47, 000.51, 000.53, 000.54, 000.56, 000.57, 000.59, 000.183, 000.204, 000.222
// shows 000.224..000.226
TEST(Manual000, DownloadsExpeditedAndInSegments) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 22 05 10 00 A1 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0xA1u);
  EXPECT_EQ(drive.ask("605 21 05 10 00 04 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 AA AA AA"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0xA2u);
}

// shows 000.47, 000.51
TEST(Manual000, ASegmentedDownloadCountsWhenItsLastSegmentHasCome) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 0A A2 00 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0x80u);
  EXPECT_EQ(drive.ask("605 1B 00 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0xA2u);
}

// shows 000.48
TEST(Manual000, ANewDownloadEndsTheOldOne) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  drive.ask("605 0A A2 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 21 06 10 00 04 00 00 00"), "585 60 06 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 07 10 27 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0x80u);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::communication_cycle_period>()), 10000u);
}

// shows 000.49, 000.227
TEST(Manual000, ANewUploadEndsTheOldOne) {
  Drive drive;
  drive.ask("605 40 08 10 00 00 00 00 00");
  drive.ask("605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 09 10 00 00 00 00 00"), "585 41 09 10 00 06 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 03 30 30 2E 31 30 30 00");
}

// shows 000.45, 000.50, 000.58, 000.227, 000.231
TEST(Manual000, AnAbortEndsATransferAndIsNotAnswered) {
  Drive drive;
  drive.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 80 05 10 00 00 00 00 08"), "");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0x80u);
}

// shows 000.52, 000.231, 000.351
TEST(Manual000, AToggleBitThatDoesNotAlternateEndsTheTransfer) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 17 A2 00 00 00 00 00 00"), "585 80 05 10 00 00 00 03 05");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 00 00 00"), "585 80 00 00 00 01 00 04 05");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::cob_id_sync>()), 0x80u);
}

// shows 000.62, 000.223
TEST(Manual000, RefusesWrongLengths) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 17 10 00 00 00 00 00"), "585 80 17 10 00 12 00 07 06");
  EXPECT_EQ(drive.ask("605 2F 17 10 00 00 00 00 00"), "585 80 17 10 00 13 00 07 06");
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 0B A2 00 00 00 00 00 00"), "585 80 05 10 00 10 00 07 06");
}

// shows 000.63, 000.77, 000.306, 000.318
TEST(Manual000, RefusesInvalidAndHighValues) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2F 00 14 02 F1 00 00 00"), "585 80 00 14 02 30 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 00 18 02 FD 00 00 00"), "585 80 00 18 02 30 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 19 10 00 F1 00 00 00"), "585 80 19 10 00 31 00 09 06");
  for (std::uint32_t type = 0; type <= 255; ++type) {
    const bool reserved = type >= 0xF1 && type <= 0xFD;
    EXPECT_EQ(write(drive, 0x1400, 2, 1, type), reserved ? refused(0x1400, 2, invalid_value) : taken(0x1400, 2));
    EXPECT_EQ(write(drive, 0x1800, 2, 1, type), reserved ? refused(0x1800, 2, invalid_value) : taken(0x1800, 2));
  }
}

// COB-IDs

// shows 000.8, 000.10, 000.12, 000.197
TEST(Manual000, SyncAndPdosTakeNewCanIds) {
  Drive drive;
  start_with(drive, 0x1800, 1);
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("080"), "");
  EXPECT_EQ(drive.ask("0A0"), "185 00 00");
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 C0"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 18 01 33 03 00 40"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("0A0"), "333 00 00");
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 14 01 22 02 00 00"), "585 60 00 14 01 00 00 00 00");
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  drive.ask("222 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
}

constexpr std::uint32_t restricted[] = {0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x5FF, 0x601,
                                        0x67F, 0x6E0, 0x6FF, 0x701, 0x77F, 0x780, 0x7FF};

// shows 000.15, 000.16, 000.185, 000.337
TEST(Manual000, RefusesRestrictedCanIds) {
  Drive drive;
  write(drive, 0x1400, 1, 4, 0x8000'0205);
  write(drive, 0x1800, 1, 4, 0xC000'0185);
  for (const std::uint32_t can_id : restricted) {
    EXPECT_EQ(write(drive, 0x1005, 0, 4, can_id), refused(0x1005, 0, invalid_value)) << can_id;
    EXPECT_EQ(write(drive, 0x1400, 1, 4, can_id), refused(0x1400, 1, invalid_value)) << can_id;
    EXPECT_EQ(write(drive, 0x1800, 1, 4, 0x4000'0000 | can_id), refused(0x1800, 1, invalid_value)) << can_id;
  }
}

// shows 000.81, 000.341
TEST(Manual000, AnRpdoIgnoresBit30AndHasNoBit29) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 40"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 A0"), "585 80 00 14 01 30 00 09 06");
  drive.ask(bench::start);
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
}

// shows 000.83, 000.173, 000.341
TEST(Manual000, ATpdoKeepsItsCanIdWhileItIsValid) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 00 18 01 86 01 00 40"), "585 80 00 18 01 30 00 09 06");
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 00"), "585 80 00 18 01 30 00 09 06");  // bit 30
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 60"), "585 80 00 18 01 30 00 09 06");  // bit 29
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 C0"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 18 01 86 01 00 40"), "585 60 00 18 01 00 00 00 00");
  start_with(drive, 0x1800, 1);
  EXPECT_EQ(drive.ask("080"), "186 00 00");
  drive.ask("605 23 00 18 01 86 01 00 C0");
  EXPECT_EQ(drive.ask("080"), "");
}

// shows 000.2, 000.4
TEST(Manual000, AnswersNoRemoteFrame) {
  Drive drive;
  start_with(drive, 0x1800, 255);
  EXPECT_EQ(drive.ask("185 R 2"), "");
  EXPECT_EQ(drive.ask("185 R 0"), "");
  EXPECT_EQ(drive.ask("705 R 1"), "");
  EXPECT_EQ(drive.pass(1s), "");
}

}  // namespace
