/// Manual 000: the servo drive cpc TC1 as node 5.
#include <gtest/gtest.h>

#include <array>
#include <cpc_tc1/device.hpp>
#include <string>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
namespace od = cpc_tc1::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpc_tc1::Device>;

constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr std::uint32_t value_too_high = 0x0609'0031;
constexpr std::uint32_t not_mappable = 0x0604'0041;

/// Leaves one TPDO valid, sets its transmission type and event timer, and starts the drive.
void start_with(Drive& drive, std::uint16_t tpdo, std::uint32_t type, std::uint32_t event_timer = 0) {
  for (std::uint16_t other = 0x1800; other <= 0x1803; ++other) {
    if (other != tpdo) write(drive, other, 1, 4, 0xC000'0000);
  }
  write(drive, tpdo, 2, 1, type);
  write(drive, tpdo, 5, 2, event_timer);
  drive.ask(bench::start);
  drive.pass(0s);
}

// Object dictionary

// shows 000.6, 000.7, 000.10, 000.11, 000.21, 000.28, 000.111, 000.130, 000.135, 000.137, 000.141, 000.142, 000.145
// shows 000.155, 000.162, 000.166..000.169
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

// shows 000.4, 000.6, 000.180, 000.181
TEST(Manual000, HasNoObjectsOfWhatIsNotImplemented) {
  Drive drive;
  for (const auto& [first, last] : missing_objects) {
    for (std::uint16_t index = first; index <= last; ++index) {
      EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, 0, 0)), refused(index, 0, 0x0602'0000));
    }
  }
}

// shows 000.84, 000.172, 000.176
TEST(Manual000, RefusesEveryAccessToSubIndex4OfATpdo) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
  EXPECT_EQ(drive.ask("605 40 00 18 06 00 00 00 00"), "585 80 00 18 06 11 00 09 06");
}

// shows 000.26, 000.55
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
  EXPECT_EQ(drive.node.get<od::tpdo_communication_parameter_1::event_timer>(), 276);
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

// shows 000.46, 000.47, 000.51, 000.53, 000.54, 000.56, 000.57, 000.59, 000.183
TEST(Manual000, DownloadsExpeditedAndInSegments) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 A0 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 22 05 10 00 A1 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0xA1u);
  EXPECT_EQ(drive.ask("605 21 05 10 00 04 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 AA AA AA"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0xA2u);
}

// shows 000.47, 000.51
TEST(Manual000, ASegmentedDownloadCountsWhenItsLastSegmentHasCome) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 0A A2 00 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0x80u);
  EXPECT_EQ(drive.ask("605 1B 00 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0xA2u);
}

// shows 000.48
TEST(Manual000, ANewDownloadEndsTheOldOne) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  drive.ask("605 0A A2 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 21 06 10 00 04 00 00 00"), "585 60 06 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 07 10 27 00 00 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0x80u);
  EXPECT_EQ(drive.node.get<od::communication_cycle_period>(), 10000u);
}

// shows 000.49
TEST(Manual000, ANewUploadEndsTheOldOne) {
  Drive drive;
  drive.ask("605 40 08 10 00 00 00 00 00");
  drive.ask("605 60 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 09 10 00 00 00 00 00"), "585 41 09 10 00 06 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 03 30 30 2E 31 30 30 00");
}

// shows 000.45, 000.50, 000.58
TEST(Manual000, AnAbortEndsATransferAndIsNotAnswered) {
  Drive drive;
  drive.ask("605 40 08 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 80 08 10 00 00 00 00 08"), "");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 80 08 10 00 01 00 04 05");
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 80 05 10 00 00 00 00 08"), "");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 00 00 00"), "585 80 05 10 00 01 00 04 05");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0x80u);
}

// shows 000.52
TEST(Manual000, AToggleBitThatDoesNotAlternateEndsTheTransfer) {
  Drive drive;
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 17 A2 00 00 00 00 00 00"), "585 80 05 10 00 00 00 03 05");
  EXPECT_EQ(drive.ask("605 07 A2 00 00 00 00 00 00"), "585 80 05 10 00 01 00 04 05");
  EXPECT_EQ(drive.node.get<od::cob_id_sync>(), 0x80u);
}

// shows 000.62
TEST(Manual000, RefusesWrongLengths) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 17 10 00 00 00 00 00"), "585 80 17 10 00 12 00 07 06");
  EXPECT_EQ(drive.ask("605 2F 17 10 00 00 00 00 00"), "585 80 17 10 00 13 00 07 06");
  drive.ask("605 21 05 10 00 04 00 00 00");
  EXPECT_EQ(drive.ask("605 0B A2 00 00 00 00 00 00"), "585 80 05 10 00 10 00 07 06");
}

// shows 000.63, 000.77
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

// shows 000.8, 000.10, 000.12
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
  EXPECT_EQ(drive.node.get<od::controlword>(), 0);
  drive.ask("222 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F);
}

constexpr std::uint32_t restricted[] = {0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x5FF, 0x601,
                                        0x67F, 0x6E0, 0x6FF, 0x701, 0x77F, 0x780, 0x7FF};

// shows 000.15, 000.16
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

// shows 000.81
TEST(Manual000, AnRpdoIgnoresBit30AndHasNoBit29) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 40"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 A0"), "585 80 00 14 01 30 00 09 06");
  drive.ask(bench::start);
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F);
}

// shows 000.83, 000.173
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

// PDO

// shows 000.34, 000.35, 000.36
TEST(Manual000, ServesPdosInOperationalOnly) {
  Drive drive;
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0);
  drive.node.set<od::statusword>(0x37);
  EXPECT_EQ(drive.pass(1s), "");
  drive.ask(bench::stop);
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask(bench::start),
            "185 37 00 | 285 37 00 00 00 00 00 | 385 37 00 00 00 00 00 | 485 37 00 00 00 00 00");
  drive.ask("205 0F 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F);
}

// shows 000.86, 000.88
TEST(Manual000, PdosHaveTheLengthAndOrderOfTheirMapping) {
  Drive drive;
  write(drive, 0x1401, 1, 4, 0x305);
  write(drive, 0x1402, 1, 4, 0x405);
  write(drive, 0x1403, 1, 4, 0x505);
  drive.node.set<od::statusword>(0x1234);
  drive.node.set<od::position_actual_value>(0x0A0B0C0D);
  drive.node.set<od::velocity_actual_value>(-2);
  EXPECT_EQ(drive.ask(bench::start),
            "185 34 12 | 285 34 12 0D 0C 0B 0A | 385 34 12 FE FF FF FF | 485 34 12 FE FF FF FF");
  drive.ask("305 0F 00 01 02 03 04");
  EXPECT_EQ(drive.node.get<od::target_position>(), 0x04030201);
  drive.ask("405 1F 00 FF FF FF FF");
  EXPECT_EQ(drive.node.get<od::target_velocity>(), -1);
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x1F);
  EXPECT_EQ(drive.ask("505"), "");
}

// shows 000.66
TEST(Manual000, TakesSynchronousRpdosAtTheNextSync) {
  for (const std::uint32_t type : {0u, 1u, 240u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0) << type;
    drive.ask("080");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F) << type;
  }
}

// shows 000.67
TEST(Manual000, TakesEventDrivenRpdosAtOnce) {
  for (const std::uint32_t type : {254u, 255u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F) << type;
  }
}

// shows 000.68, 000.71
TEST(Manual000, SendsTypeNAtEveryNthSync) {
  Drive drive;
  start_with(drive, 0x1800, 3);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(drive.ask("080"), "");
    EXPECT_EQ(drive.ask("080"), "");
    EXPECT_EQ(drive.ask("080"), "185 00 00");
  }
}

// shows 000.69, 000.174
TEST(Manual000, SendsTypes0And1AtEverySync) {
  for (const std::uint32_t type : {0u, 1u}) {
    Drive drive;
    start_with(drive, 0x1800, type);
    EXPECT_EQ(drive.ask("080"), "185 00 00") << type;
    EXPECT_EQ(drive.ask("080"), "185 00 00") << type;
  }
}

// shows 000.70
TEST(Manual000, SamplesAtTheSync) {
  Drive drive;
  start_with(drive, 0x1800, 1);
  drive.node.set<od::statusword>(1);
  EXPECT_EQ(drive.pass(1s), "");
  drive.node.set<od::statusword>(2);
  EXPECT_EQ(drive.ask("080"), "185 02 00");
}

// shows 000.72, 000.76
TEST(Manual000, SendsEventDrivenTpdosAtAChangeAndByTheirTimer) {
  for (const std::uint32_t type : {254u, 255u}) {
    Drive drive;
    start_with(drive, 0x1800, type, 100);
    drive.node.set<od::statusword>(0x37);
    EXPECT_EQ(drive.pass(0s), "185 37 00");
    EXPECT_EQ(drive.pass(99ms), "");
    EXPECT_EQ(drive.pass(1ms), "185 37 00");
  }
}

// shows 000.75
TEST(Manual000, AnEventTimerOf0IsOff) {
  Drive drive;
  start_with(drive, 0x1800, 255, 0);
  EXPECT_EQ(drive.pass(10s), "");
}

// shows 000.19, 000.73, 000.74
TEST(Manual000, KeepsTheInhibitTimeAndItsParameterWhileThePdoIsValid) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 00 18 03 64 00 00 00"), "585 80 00 18 03 22 00 00 08");
  write(drive, 0x1800, 1, 4, 0xC000'0185);
  EXPECT_EQ(drive.ask("605 2B 00 18 03 64 00 00 00"), "585 60 00 18 03 00 00 00 00");  // 10 ms
  write(drive, 0x1800, 1, 4, 0x4000'0185);
  start_with(drive, 0x1800, 255);
  drive.node.set<od::statusword>(1);
  EXPECT_EQ(drive.pass(9999us), "");
  EXPECT_EQ(drive.pass(1us), "185 01 00");
}

// shows 000.96, 000.97
TEST(Manual000, TakesLongerRpdosAndNoShorterOnes) {
  Drive drive;
  start_with(drive, 0x1800, 255);
  EXPECT_EQ(drive.ask("205 0F"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0);
  EXPECT_EQ(drive.ask("205 1F 00 AA BB"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.node.get<od::controlword>(), 0x1F);
}

// Mapping

// shows 000.86, 000.91
TEST(Manual000, IsRemappedInFiveSteps) {
  for (const char* state : {bench::enter_pre_operational, bench::start}) {
    Drive drive;
    drive.ask(state);
    EXPECT_EQ(drive.ask("605 23 01 18 01 85 02 00 C0"), "585 60 01 18 01 00 00 00 00");
    EXPECT_EQ(drive.ask("605 2F 01 1A 00 00 00 00 00"), "585 60 01 1A 00 00 00 00 00");
    EXPECT_EQ(drive.ask("605 23 01 1A 01 20 00 64 60"), "585 60 01 1A 01 00 00 00 00");
    EXPECT_EQ(drive.ask("605 23 01 1A 02 10 00 41 60"), "585 60 01 1A 02 00 00 00 00");
    EXPECT_EQ(drive.ask("605 2F 01 1A 00 02 00 00 00"), "585 60 01 1A 00 00 00 00 00");
    drive.ask("605 23 01 18 01 85 02 00 40");
    start_with(drive, 0x1801, 1);
    drive.node.set<od::position_actual_value>(0x01020304);
    drive.node.set<od::statusword>(0x0605);
    EXPECT_EQ(drive.ask("080"), "285 04 03 02 01 05 06");
  }
}

/// A drive whose RPDO1 is not valid and maps nothing.
struct Remapping : Drive {
  Remapping() {
    ask("605 23 00 14 01 05 02 00 80");
    ask("605 2F 00 16 00 00 00 00 00");
  }
};

// shows 000.90, 000.92, 000.171
TEST(Manual000, RefusesEntriesThatCannotBeMapped) {
  Remapping drive;
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x2FFF'0010), refused(0x1600, 1, not_mappable));  // no such object
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x6041'0010), refused(0x1600, 1, not_mappable));  // not in this direction
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x6040'0020), refused(0x1600, 1, not_mappable));  // another length
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x6040'0010), taken(0x1600, 1));
}

// shows 000.85, 000.90, 000.93, 000.170
TEST(Manual000, RefusesANumberOfEntriesThatMakesNoPdo) {
  Remapping drive;
  write(drive, 0x1600, 1, 4, 0x607A'0020);
  write(drive, 0x1600, 2, 4, 0x60FF'0020);
  write(drive, 0x1600, 3, 4, 0x6040'0010);
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 3), refused(0x1600, 0, not_mappable));  // 80 bits
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 4), refused(0x1600, 0, not_mappable));  // entry 4 is empty
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 5), refused(0x1600, 0, not_mappable));
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 2), taken(0x1600, 0));
}

/// Chapter 12, 1800h: "This bit is always 1", also for a PDO that is not valid.
TEST(Manual000, KeepsBit30OfATpdoThatIsNotValid) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 C0"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 80"), "585 80 00 18 01 30 00 09 06");
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 00"), "585 80 00 18 01 30 00 09 06");
  EXPECT_EQ(drive.ask("605 40 00 18 01 00 00 00 00"), "585 43 00 18 01 85 01 00 C0");
}

// shows 000.94
TEST(Manual000, RefusesEntriesOutOfTheOrderOfTheSteps) {
  Drive drive;
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x607A'0020), refused(0x1600, 1, 0x0601'0000));
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 0), refused(0x1600, 0, 0x0601'0000));
  write(drive, 0x1400, 1, 4, 0x8000'0205);
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x607A'0020), refused(0x1600, 1, 0x0601'0000));
}

TEST(Manual000, MapsDummiesOf2To7) {
  constexpr std::uint32_t dummies[] = {0x0002'0008, 0x0003'0010, 0x0004'0020, 0x0005'0008, 0x0006'0010, 0x0007'0020};
  for (const std::uint32_t dummy : dummies) {
    Remapping drive;
    EXPECT_EQ(write(drive, 0x1600, 1, 4, dummy), taken(0x1600, 1)) << dummy;
    write(drive, 0x1600, 2, 4, 0x6040'0010);
    EXPECT_EQ(write(drive, 0x1600, 0, 1, 2), taken(0x1600, 0));
    write(drive, 0x1400, 1, 4, 0x205);
    drive.ask(bench::start);
    const std::string skipped[] = {"", " AA", " AA AA", "", " AA AA AA AA"};
    drive.ask("205" + skipped[(dummy & 0xFF) / 8] + " 0F 00");
    EXPECT_EQ(drive.node.get<od::controlword>(), 0x0F) << dummy;
  }
}

// shows 000.95
TEST(Manual000, MapsTheDummyReal32) {
  Remapping drive;
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x0008'0020), taken(0x1600, 1));
  EXPECT_EQ(write(drive, 0x1600, 1, 4, 0x0009'0020), refused(0x1600, 1, not_mappable));
}

// shows 000.5
TEST(Manual000, HasNoMpdo) {
  Remapping drive;
  write(drive, 0x1600, 1, 4, 0x6040'0010);
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 254), refused(0x1600, 0, not_mappable));
  EXPECT_EQ(write(drive, 0x1600, 0, 1, 255), refused(0x1600, 0, not_mappable));
}

// shows 000.99, 000.160
TEST(Manual000, MapsOf1xxxhOnly1013h) {
  Drive drive;
  drive.ask("605 23 00 18 01 85 01 00 C0");
  drive.ask("605 2F 00 1A 00 00 00 00 00");
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x1001'0008), refused(0x1A00, 1, not_mappable));
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x1002'0020), refused(0x1A00, 1, not_mappable));
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x1017'0010), refused(0x1A00, 1, not_mappable));
  EXPECT_EQ(write(drive, 0x1A00, 1, 4, 0x1013'0020), taken(0x1A00, 1));
}

// Error control

// shows 000.44, 000.132
TEST(Manual000, WatchesANodeFromItsFirstHeartbeatOn) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 16 10 01 64 00 07 00"), "585 60 16 10 01 00 00 00 00");  // node 7, 100 ms
  EXPECT_EQ(drive.pass(10s), "");
  EXPECT_EQ(drive.node.state_of(canopen::NodeId{7}), std::nullopt);
  EXPECT_EQ(drive.ask("707 05"), "");
  EXPECT_EQ(drive.node.state_of(canopen::NodeId{7}), canopen::NmtState::operational);
  EXPECT_EQ(drive.pass(99'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
}

// shows 000.133
TEST(Manual000, DoesNotUseAnEntryOf1016hWithoutTimeOrNode) {
  struct Row {
    std::uint32_t entry;
    const char* heartbeat;
  };
  constexpr Row rows[] = {{0x0007'0000, "707 05"}, {0x0000'0064, "700 05"}, {0x0080'0064, "780 05"}};
  for (const auto& [entry, heartbeat] : rows) {
    Drive drive;
    EXPECT_EQ(write(drive, 0x1016, 1, 4, entry), taken(0x1016, 1)) << entry;
    drive.ask(heartbeat);
    EXPECT_EQ(drive.pass(10s), "") << entry;
  }
}

// shows 000.134
TEST(Manual000, RefusesASecondTimeForANode) {
  Drive drive;
  write(drive, 0x1016, 1, 4, 0x0007'0064);
  EXPECT_EQ(write(drive, 0x1016, 2, 4, 0x0007'00C8), refused(0x1016, 2, 0x0604'0043));
  EXPECT_EQ(write(drive, 0x1016, 2, 4, 0x0007'0000), taken(0x1016, 2));
  EXPECT_EQ(write(drive, 0x1016, 2, 4, 0x0008'00C8), taken(0x1016, 2));
}

// EMCY

// shows 000.38
TEST(Manual000, SendsTheLastErrorOfStopped) {
  Drive drive;
  drive.ask(bench::stop);
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.node.emergency(0x3210, ErrorRegister::voltage);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask(bench::enter_pre_operational), "085 10 32 07 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 10 23 00 00");
}

// shows 000.39, 000.154
TEST(Manual000, RecordsErrorsOfStopped) {
  Drive drive;
  drive.ask(bench::stop);
  drive.node.emergency(0x2310, ErrorRegister::current);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "");
  EXPECT_EQ(drive.ask(bench::enter_pre_operational), "085 10 23 03 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 10 23 00 00");
}

// shows 000.100, 000.102, 000.104, 000.113, 000.115..000.117
TEST(Manual000, RecordsSixteenErrorsNewestFirst) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 80 03 10 01 24 00 00 08");
  for (std::uint16_t code = 0x2301; code <= 0x2311; ++code) {
    drive.node.emergency(code, ErrorRegister::current);
    drive.pass(1ms);
    drive.node.emergency_over(ErrorRegister::current);
    drive.pass(1ms);
  }
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 10 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 11 23 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 10 23 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 10 00 00 00 00"), "585 43 03 10 10 02 23 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 11 00 00 00 00"), "585 80 03 10 11 11 00 09 06");
}

// shows 000.114, 000.153
TEST(Manual000, EmptiesTheHistoryWith0Only) {
  Drive drive;
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.pass(0s);
  EXPECT_EQ(drive.ask("605 2F 03 10 00 01 00 00 00"), "585 80 03 10 00 31 00 09 06");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 01 00 00 00");
  EXPECT_EQ(drive.ask("605 2F 03 10 00 00 00 00 00"), "585 60 03 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
}

// shows 000.110, 000.163
TEST(Manual000, KeepsTheInhibitTimeOfEmcy) {
  Drive drive;
  drive.ask("605 2B 15 10 00 64 00 00 00");  // 10 ms
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.node.emergency(0x3210, ErrorRegister::voltage);
  EXPECT_EQ(drive.pass(9999us), "085 10 23 03 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1us), "085 10 32 07 00 00 00 00 00");
}

// shows 000.112, 000.152, 000.190
TEST(Manual000, SetsTheGenericErrorWithEveryOther) {
  constexpr std::uint8_t bits[] = {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x80};
  for (const std::uint8_t bit : bits) {
    Drive drive;
    drive.node.emergency(0x1000, static_cast<ErrorRegister>(bit));
    drive.pass(0s);
    EXPECT_EQ(drive.node.get<od::error_register>(), bit | 1);
  }
}

// SYNC

// shows 000.118, 000.121..000.123, 000.156, 000.157
TEST(Manual000, ProducesSyncEvery1006hMicroseconds) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2F 19 10 00 03 00 00 00"), "585 60 19 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 06 10 00 10 27 00 00"), "585 60 06 10 00 00 00 00 00");  // 10 ms
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 40"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.pass(10ms), "080 01");
  EXPECT_EQ(drive.pass(30ms), "080 02 | 080 03 | 080 01");
  EXPECT_EQ(drive.ask("605 23 06 10 00 00 00 00 00"), "585 60 06 10 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 23 06 10 00 20 4E 00 00"), "585 60 06 10 00 00 00 00 00");
  EXPECT_EQ(drive.pass(20ms), "080 01");
}

// shows 000.124
TEST(Manual000, CountsSyncFrom1AfterStopped) {
  for (const char* command : {bench::enter_pre_operational, bench::start}) {
    Drive drive;
    for (std::uint16_t tpdo = 0x1800; tpdo <= 0x1803; ++tpdo) write(drive, tpdo, 1, 4, 0xC000'0000);
    write(drive, 0x1019, 0, 1, 10);
    write(drive, 0x1006, 0, 4, 10000);
    write(drive, 0x1005, 0, 4, 0x4000'0080);
    EXPECT_EQ(drive.pass(20ms), "080 01 | 080 02");
    drive.ask(bench::stop);
    EXPECT_EQ(drive.pass(20ms), "");
    drive.ask(command);
    EXPECT_EQ(drive.pass(10ms), "080 01");
  }
}

// shows 000.120
TEST(Manual000, KeepsTheCanIdOfSyncWhileItIsProduced) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 20"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 80"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 40"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 05 10 00 81 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 05 10 00 81 00 00 40"), "585 60 05 10 00 00 00 00 00");
}

// shows 000.125, 000.164
TEST(Manual000, HasReservedCounterOverflowValues) {
  Drive drive;
  for (std::uint32_t value = 0; value <= 255; ++value) {
    const std::string answer = write(drive, 0x1019, 0, 1, value);
    if (value == 1) {
      EXPECT_EQ(answer, refused(0x1019, 0, invalid_value));
    } else {
      EXPECT_EQ(answer, value <= 240 ? taken(0x1019, 0) : refused(0x1019, 0, value_too_high));
    }
  }
}

// shows 000.126, 000.127, 000.165
TEST(Manual000, LooksAtTheLengthOfSyncNotAtItsCounter) {
  Drive drive;
  start_with(drive, 0x1800, 1);
  EXPECT_EQ(drive.ask("080 01"), "085 40 82 11 00 00 00 00 00");
  EXPECT_EQ(drive.ask("080"), "085 00 00 00 00 00 00 00 00 | 185 00 00");
  drive.ask("605 2F 19 10 00 0A 00 00 00");
  EXPECT_EQ(drive.ask("080 07"), "185 00 00");
  EXPECT_EQ(drive.ask("080 07"), "185 00 00");
  EXPECT_EQ(drive.ask("080"), "085 40 82 11 00 00 00 00 00");
}

// shows 000.130
TEST(Manual000, KeepsTheTimeOfTheLastSyncInMicroseconds) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 13 10 00 00 00 00 00"), "585 60 13 10 00 00 00 00 00");
  drive.pass(1234us);
  drive.ask("080");
  EXPECT_EQ(drive.ask("605 40 13 10 00 00 00 00 00"), "585 43 13 10 00 D2 04 00 00");
}

}  // namespace
