/// Manual 001: the stepper drive EZD-1136 as node 5.
#include <gtest/gtest.h>

#include <ezd_1136/device.hpp>
#include <type_traits>

#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::ro;
using manual::rw;
using manual::taken;
using manual::write;
namespace od = ezd_1136::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<ezd_1136::Device>;

constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr std::uint32_t no_object = 0x0602'0000;

/// What the drive sends when it enters Operational.
constexpr auto started = "185 00 00 00 00 01 | 285 00 00 00 00 00 00 00 00 | 385 00 00 00 00 00 00";

// Object dictionary

// shows 001.7, 001.9, 001.78..001.82, 001.125
TEST(Manual001, HasTheCommunicationObjects) {
  constexpr manual::Entry entries[] = {
      {0x1000, 0, 4, ro, 0x0004'0192}, {0x1001, 0, 1, ro, 0},     {0x1003, 0, 1, rw, 0},     {0x1005, 0, 4, rw, 0x80},
      {0x1006, 0, 4, rw, 0},           {0x100C, 0, 2, rw, 0},     {0x100D, 0, 1, rw, 0},     {0x1014, 0, 4, rw, 0x85},
      {0x1016, 0, 1, ro, 1},           {0x1016, 1, 4, rw, 0},     {0x1017, 0, 2, rw, 0},     {0x1018, 0, 1, ro, 4},
      {0x1200, 0, 1, ro, 2},           {0x1200, 1, 4, ro, 0x605}, {0x1200, 2, 4, ro, 0x585},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
  constexpr std::uint16_t missing[] = {0x1007, 0x1015, 0x1024};
  for (const std::uint16_t index : missing) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, 0, 0)), refused(index, 0, no_object));
  }
  EXPECT_EQ(drive.ask("605 40 08 10 00 00 00 00 00"), "585 41 08 10 00 08 00 00 00");
  EXPECT_EQ(drive.ask("605 60 00 00 00 00 00 00 00"), "585 00 45 5A 44 2D 31 31 33");
  EXPECT_EQ(drive.ask("605 70 00 00 00 00 00 00 00"), "585 1D 36 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 21 08 10 00 08 00 00 00"), "585 80 08 10 00 02 00 01 06");
}

// shows 001.7, 001.26, 001.36, 001.39, 001.81, 001.125, 001.138, 001.139
TEST(Manual001, HasFourPdosOfEachDirectionAndTheirDefaultMapping) {
  constexpr manual::Entry entries[] = {
      {0x1400, 1, 4, rw, 0x205},       {0x1401, 1, 4, rw, 0x305},       {0x1402, 1, 4, rw, 0x405},
      {0x1403, 1, 4, rw, 0x505},       {0x1800, 1, 4, rw, 0x185},       {0x1801, 1, 4, rw, 0x285},
      {0x1802, 1, 4, rw, 0x385},       {0x1803, 1, 4, rw, 0x485},       {0x1600, 0, 1, rw, 4},
      {0x1600, 1, 4, rw, 0x6040'0010}, {0x1600, 2, 4, rw, 0x6060'0008}, {0x1600, 3, 4, rw, 0x6098'0008},
      {0x1600, 4, 4, rw, 0x607C'0020}, {0x1600, 8, 4, rw, 0},           {0x1601, 0, 1, rw, 2},
      {0x1601, 1, 4, rw, 0x607A'0020}, {0x1601, 2, 4, rw, 0x6081'0020}, {0x1602, 0, 1, rw, 2},
      {0x1602, 1, 4, rw, 0x60FF'0020}, {0x1602, 2, 4, rw, 0x6085'0020}, {0x1603, 0, 1, rw, 2},
      {0x1603, 1, 4, rw, 0x6083'0020}, {0x1603, 2, 4, rw, 0x6084'0020}, {0x1A00, 0, 1, rw, 3},
      {0x1A00, 1, 4, rw, 0x6041'0010}, {0x1A00, 2, 4, rw, 0x603F'0010}, {0x1A00, 3, 4, rw, 0x6061'0008},
      {0x1A01, 0, 1, rw, 2},           {0x1A01, 1, 4, rw, 0x6064'0020}, {0x1A01, 2, 4, rw, 0x606C'0020},
      {0x1A02, 0, 1, rw, 2},           {0x1A02, 1, 4, rw, 0x207C'0010}, {0x1A02, 2, 4, rw, 0x60FD'0020},
      {0x1A03, 0, 1, rw, 0},           {0x1A03, 8, 4, rw, 0},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
  EXPECT_EQ(drive.ask("605 40 04 14 00 00 00 00 00"), "585 80 04 14 00 00 00 02 06");
  EXPECT_EQ(drive.ask("605 40 04 18 00 00 00 00 00"), "585 80 04 18 00 00 00 02 06");
}

// shows 001.49, 001.51..001.53, 001.94, 001.96, 001.97, 001.101, 001.103
TEST(Manual001, HasTheParametersOfTheDrive) {
  constexpr manual::Entry entries[] = {
      {0x211E, 0, 2, rw, 10},          {0x211F, 0, 2, rw, 500},         {0x21E8, 0, 4, rw, 0}, {0x603F, 0, 2, ro, 0},
      {0x605A, 0, 2, rw, 2},           {0x605B, 0, 2, rw, 0},           {0x605C, 0, 2, rw, 1}, {0x605E, 0, 2, rw, 2},
      {0x6071, 0, 2, rw, 0},           {0x6074, 0, 2, ro, 0},           {0x6078, 0, 2, ro, 0}, {0x607C, 0, 4, rw, 0},
      {0x607D, 1, 4, rw, 0x88CA'6C00}, {0x607D, 2, 4, rw, 0x7735'9400}, {0x6082, 0, 4, rw, 0}, {0x6087, 0, 4, rw, 0},
      {0x6098, 0, 1, rw, 0},           {0x60B0, 0, 4, rw, 0},           {0x60FD, 0, 4, ro, 0}, {0x60FE, 1, 4, rw, 0},
      {0x6502, 0, 4, ro, 37},
  };
  Drive drive;
  manual::expect_entries(drive, entries);
  constexpr std::uint32_t modes[] = {1, 3, 6, 8};
  for (const std::uint32_t mode : modes) EXPECT_EQ(write(drive, 0x6060, 0, 1, mode), taken(0x6060, 0));
  constexpr std::uint32_t quick_stops[] = {1, 2, 5, 6};
  for (const std::uint32_t code : quick_stops) EXPECT_EQ(write(drive, 0x605A, 0, 2, code), taken(0x605A, 0));
  EXPECT_EQ(write(drive, 0x605A, 0, 2, 7), refused(0x605A, 0, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x605A, 0, 2, 0), refused(0x605A, 0, 0x0609'0032));
}

// shows 001.74
TEST(Manual001, HasRangesOfItsSettings) {
  Drive drive;
  EXPECT_EQ(write(drive, 0x20C9, 0, 2, 3), taken(0x20C9, 0));
  EXPECT_EQ(write(drive, 0x20C9, 0, 2, 4), refused(0x20C9, 0, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x20D9, 0, 2, 1), taken(0x20D9, 0));
  EXPECT_EQ(write(drive, 0x20D9, 0, 2, 2), refused(0x20D9, 0, 0x0609'0031));
  EXPECT_EQ(write(drive, 0x2127, 0, 2, 1), taken(0x2127, 0));
  EXPECT_EQ(write(drive, 0x2127, 0, 2, 2), refused(0x2127, 0, 0x0609'0031));
}

// shows 001.9, 001.76, 001.92, 001.93, 000.60, 002.18
TEST(Manual001, HasWriteOnlyObjects) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 40 CE 20 00 00 00 00 00"), "585 80 CE 20 00 01 00 01 06");
  EXPECT_EQ(drive.ask("605 2B CE 20 00 05 00 00 00"), "585 60 CE 20 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 AD 21 00 00 00 00 00"), "585 80 AD 21 00 01 00 01 06");
  EXPECT_EQ(drive.ask("605 2B AD 21 00 01 00 00 00"), "585 60 AD 21 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 AE 21 00 00 00 00 00"), "585 80 AE 21 00 01 00 01 06");
}

// shows 001.98
TEST(Manual001, HasTheTypesOfTheParameterList) {
  static_assert(std::is_same_v<canopen::RawOf<od::home_offset::type>, std::int32_t>);
  static_assert(std::is_same_v<canopen::RawOf<od::profile_acceleration::type>, std::uint32_t>);
  Drive drive;
  drive.node.set<od::home_offset>(canopen::raw(-2));
  EXPECT_EQ(drive.ask("605 40 7C 60 00 00 00 00 00"), "585 43 7C 60 00 FE FF FF FF");
}

// PDO parameters

// shows 001.27
TEST(Manual001, APdoIsValidWhileBit31Is0) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 80"), "585 60 00 18 01 00 00 00 00");
  EXPECT_EQ(drive.ask(bench::start), std::string{started}.substr(21));
  drive.ask("205 0F 00 01 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  drive.ask("605 23 00 14 01 05 02 00 00");
  drive.ask("205 0F 00 01 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
}

// shows 001.28
TEST(Manual001, KeepsItsNodeIdInTheCobIdsOfPdos) {
  Drive drive;
  write(drive, 0x1800, 1, 4, 0x8000'0185);
  write(drive, 0x1800, 1, 4, 0x0000'0286);
  EXPECT_EQ(drive.ask("605 40 00 18 01 00 00 00 00").substr(16, 2), "85");
}

TEST(Manual001, RefusesTransmissionTypes241To251) {
  Drive drive;
  for (std::uint32_t type = 0; type <= 251; ++type) {
    EXPECT_EQ(write(drive, 0x1800, 2, 1, type), type > 240 ? refused(0x1800, 2, invalid_value) : taken(0x1800, 2));
  }
}

// shows 001.77
TEST(Manual001, TakesTransmissionTypes254And255) {
  Drive drive;
  constexpr std::uint32_t types[] = {254, 255};
  for (const std::uint32_t type : types) {
    EXPECT_EQ(write(drive, 0x1800, 2, 1, type), taken(0x1800, 2));
    EXPECT_EQ(write(drive, 0x1400, 2, 1, type), taken(0x1400, 2));
  }
}

// shows 001.33
TEST(Manual001, RefusesTransmissionTypes252And253) {
  Drive drive;
  EXPECT_EQ(write(drive, 0x1800, 2, 1, 252), refused(0x1800, 2, invalid_value));
  EXPECT_EQ(write(drive, 0x1800, 2, 1, 253), refused(0x1800, 2, invalid_value));
}

// shows 001.36, 001.87
TEST(Manual001, MapsUpToEightBytes) {
  Drive drive;
  write(drive, 0x1401, 1, 4, 0x8000'0305);
  EXPECT_EQ(write(drive, 0x1601, 0, 1, 0), taken(0x1601, 0));
  for (std::uint8_t i = 1; i <= 8; ++i) EXPECT_EQ(write(drive, 0x1601, i, 4, 0x6060'0008), taken(0x1601, i));
  EXPECT_EQ(write(drive, 0x1601, 0, 1, 8), taken(0x1601, 0));
  write(drive, 0x1601, 0, 1, 0);
  EXPECT_EQ(write(drive, 0x1601, 8, 4, 0x6040'0010), taken(0x1601, 8));
  EXPECT_EQ(write(drive, 0x1601, 0, 1, 8), refused(0x1601, 0, 0x0604'0042));
}

// shows 001.37
TEST(Manual001, AMappingEntryIsIndexSubIndexAndLength) {
  Drive drive;
  write(drive, 0x1803, 1, 4, 0x8000'0485);
  EXPECT_EQ(drive.ask("605 23 03 1A 01 20 00 64 60"), "585 60 03 1A 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 03 1A 02 10 00 41 60"), "585 60 03 1A 02 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 03 1A 03 08 00 61 60"), "585 60 03 1A 03 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 03 1A 04 08 00 41 60"), "585 80 03 1A 04 41 00 04 06");
  EXPECT_EQ(drive.ask("605 2F 03 1A 00 03 00 00 00"), "585 60 03 1A 00 00 00 00 00");
  write(drive, 0x1803, 1, 4, 0x0000'0485);
  drive.node.set<od::position_actual_value>(canopen::raw(0x01020304));
  drive.node.set<od::statusword>(canopen::raw(0x0250));
  EXPECT_EQ(drive.ask(bench::start),
            "185 50 02 00 00 01 | 285 04 03 02 01 00 00 00 00 | 385 00 00 00 00 00 00 | 485 04 03 02 01 50 02 01");
}

constexpr std::uint32_t mode_table_rpdo[] = {0x607A'0020, 0x6081'0020, 0x60FF'0020, 0x6040'0010, 0x6083'0020,
                                             0x6084'0020, 0x6098'0008, 0x6099'0120, 0x6099'0220, 0x609A'0020,
                                             0x607C'0020, 0x6060'0008, 0x60B0'0020, 0x6082'0020, 0x6085'0020};
constexpr std::uint32_t mode_table_tpdo[] = {0x6041'0010, 0x6064'0020, 0x606C'0020,
                                             0x60FD'0020, 0x603F'0010, 0x6061'0008};

// shows 001.71, 001.100
TEST(Manual001, MapsTheObjectsOfTheModeTableAndServesThemBySdo) {
  Drive drive;
  write(drive, 0x1403, 1, 4, 0x8000'0505);
  write(drive, 0x1603, 0, 1, 0);
  write(drive, 0x1803, 1, 4, 0x8000'0485);
  for (const std::uint32_t entry : mode_table_rpdo) EXPECT_EQ(write(drive, 0x1603, 1, 4, entry), taken(0x1603, 1));
  for (const std::uint32_t entry : mode_table_tpdo) EXPECT_EQ(write(drive, 0x1A03, 1, 4, entry), taken(0x1A03, 1));
  EXPECT_EQ(drive.ask("605 23 81 60 00 10 27 00 00"), "585 60 81 60 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 81 60 00 00 00 00 00"), "585 43 81 60 00 10 27 00 00");
}

// PDO

// shows 001.38, 001.39, 001.89, 001.126, 001.136
TEST(Manual001, PdosCarryTheirObjectsLowByteFirst) {
  Drive drive;
  drive.node.set<od::statusword>(canopen::raw(0x00F3));
  EXPECT_EQ(drive.ask(bench::start).substr(0, 18), "185 F3 00 00 00 01");
  drive.ask("205 11 22 03 11 FE FF FF FF");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x2211);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::modes_of_operation>()), 3);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::homing_method>()), 0x11);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::home_offset>()), -2);
  drive.ask("405 E8 03 00 00 01 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), 1000);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::quick_stop_deceleration>()), 1u);
}

// shows 001.29, 001.142
TEST(Manual001, SendsType0AtTheSyncAfterAChange) {
  Drive drive;
  drive.ask(bench::start);
  write(drive, 0x1800, 2, 1, 0);
  drive.ask("080");
  EXPECT_EQ(drive.ask("080"), "");
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("080"), "185 01 00 00 00 01");
  EXPECT_EQ(drive.ask("080"), "");
}

// shows 001.30, 001.139
TEST(Manual001, SendsTypeNAtEveryNthSync) {
  constexpr std::uint32_t types[] = {1, 3, 240};
  for (const std::uint32_t type : types) {
    Drive drive;
    drive.ask(bench::start);
    write(drive, 0x1800, 2, 1, type);
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t sync = 1; sync < type; ++sync) EXPECT_EQ(drive.ask("080"), "") << type << ", " << sync;
      EXPECT_EQ(drive.ask("080"), "185 00 00 00 00 01") << type;
    }
  }
}

// shows 001.31, 001.35, 001.139
TEST(Manual001, SendsTypes254And255AtAChangeAndByTheirTimer) {
  constexpr std::uint32_t types[] = {254, 255};
  for (const std::uint32_t type : types) {
    Drive drive;
    write(drive, 0x1800, 2, 1, type);
    write(drive, 0x1800, 5, 2, 100);
    EXPECT_EQ(drive.ask(bench::start), started);
    EXPECT_EQ(drive.pass(60ms), "");
    drive.node.set<od::statusword>(canopen::raw(1));
    EXPECT_EQ(drive.pass(0s), "185 01 00 00 00 01");
    EXPECT_EQ(drive.pass(99ms), "");
    EXPECT_EQ(drive.pass(1ms), "185 01 00 00 00 01");
  }
}

// shows 001.32
TEST(Manual001, TakesTheNewestRpdoAtTheNextSyncOrAtOnce) {
  constexpr std::uint32_t types[] = {0, 1, 240, 254, 255};
  for (const std::uint32_t type : types) {
    Drive drive;
    drive.ask(bench::start);
    write(drive, 0x1401, 2, 1, type);
    drive.ask("305 01 00 00 00 00 00 00 00");
    drive.ask("305 02 00 00 00 00 00 00 00");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), type > 240 ? 2 : 0) << type;
    drive.ask("080");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), 2) << type;
  }
}

// shows 001.34, 001.86, 001.139
TEST(Manual001, AnInhibitTimeOf300Is30Milliseconds) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 00 18 03 2C 01 00 00"), "585 60 00 18 03 00 00 00 00");
  EXPECT_EQ(drive.ask(bench::start), started);
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(29'999us), "");
  EXPECT_EQ(drive.pass(1us), "185 01 00 00 00 01");
}

// Error control

// shows 001.18, 001.84
TEST(Manual001, AnswersEachGuardingRequestWithItsStateAndAToggleBit) {
  Drive drive;
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
  EXPECT_EQ(drive.ask("705 R 1"), "705 FF");
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  drive.ask(bench::stop);
  EXPECT_EQ(drive.ask("705 R 1"), "705 84");
  EXPECT_EQ(drive.ask(bench::reset_communication), "705 00");
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
}

// shows 001.19, 001.20
TEST(Manual001, MissesTheMasterAfterTheLifeTime) {
  Drive drive;
  write(drive, 0x100C, 0, 2, 100);
  write(drive, 0x100D, 0, 1, 3);
  EXPECT_EQ(drive.pass(10s), "");
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
  EXPECT_EQ(drive.pass(299'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
  for (const auto& [guard_time, factor] : {std::pair{0u, 3u}, std::pair{100u, 0u}}) {
    Drive unguarded;
    write(unguarded, 0x100C, 0, 2, guard_time);
    write(unguarded, 0x100D, 0, 1, factor);
    EXPECT_EQ(unguarded.ask("705 R 1"), "705 7F");
    EXPECT_EQ(unguarded.pass(10s), "");
  }
}

// shows 001.21
TEST(Manual001, IsNotGuardedWhileItHasAHeartbeat) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 17 10 00 E8 03 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(drive.ask("705 R 1"), "");
  EXPECT_EQ(drive.ask("605 2B 17 10 00 00 00 00 00"), "585 60 17 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
}

// shows 001.24, 001.83
TEST(Manual001, WatchesANodeFromItsFirstHeartbeatOn) {
  Drive drive;
  write(drive, 0x1016, 1, 4, 0x0001'00C8);  // node 1, 200 ms
  EXPECT_EQ(drive.pass(10s), "");
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199ms), "");
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
}

// SYNC and EMCY

// shows 001.42, 001.142
TEST(Manual001, ProducesSyncWhereBit30Of1005hSaysSo) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 06 10 00 10 27 00 00"), "585 60 06 10 00 00 00 00 00");  // 10 ms
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 40"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.pass(20ms), "080 | 080");
  EXPECT_EQ(drive.ask("605 23 05 10 00 80 00 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1s), "");
}

// shows 001.43, 001.47
TEST(Manual001, TellsErrorsAndKeepsTheRecentOnes) {
  constexpr std::uint8_t bits[] = {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x80};
  Drive drive;
  for (const std::uint8_t bit : bits) {
    drive.node.emergency(std::uint16_t{0x000D}, static_cast<ErrorRegister>(bit), {1, 2, 3, 4, 5});
    drive.pass(0s);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::error_register>()), bit | 1);
    drive.node.emergency_over(static_cast<ErrorRegister>(bit));
    drive.pass(0s);
  }
  drive.node.emergency(std::uint16_t{0x080E}, ErrorRegister::voltage, {1, 2, 3, 4, 5});
  EXPECT_EQ(drive.pass(0s), "085 0E 08 05 01 02 03 04 05");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 08 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 0E 08 01 02");
  EXPECT_EQ(drive.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 0D 00 01 02");
  drive.node.start(drive.now);  // the power was off
  EXPECT_EQ(drive.bus.take(), "705 00");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
}

}  // namespace
