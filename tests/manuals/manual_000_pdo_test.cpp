/// Manual 000, the servo drive cpc TC1: transmission and mapping of PDOs.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>
#include <string>

#include "manual_000_bench.hpp"
#include "manual_bench.hpp"

namespace {

using manual::refused;
using manual::taken;
using manual::write;
using manual_000::Drive;
using manual_000::start_with;
namespace od = cpc_tc1::od;
using namespace std::chrono_literals;

constexpr std::uint32_t not_mappable = 0x0604'0041;

// PDO

// shows 000.34..000.36
TEST(Manual000, ServesPdosInOperationalOnly) {
  Drive drive;
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  drive.node.set<od::statusword>(canopen::raw(0x37));
  EXPECT_EQ(drive.pass(1s), "");
  drive.ask(bench::stop);
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask(bench::start),
            "185 37 00 | 285 37 00 00 00 00 00 | 385 37 00 00 00 00 00 | 485 37 00 00 00 00 00");
  drive.ask("205 0F 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F);
}

// shows 000.86, 000.88, 000.232
TEST(Manual000, PdosHaveTheLengthAndOrderOfTheirMapping) {
  Drive drive;
  write(drive, 0x1401, 1, 4, 0x305);
  write(drive, 0x1402, 1, 4, 0x405);
  write(drive, 0x1403, 1, 4, 0x505);
  drive.node.set<od::statusword>(canopen::raw(0x1234));
  drive.node.set<od::position_actual_value>(0x0A0B0C0D);
  drive.node.set<od::velocity_actual_value>(-2);
  EXPECT_EQ(drive.ask(bench::start),
            "185 34 12 | 285 34 12 0D 0C 0B 0A | 385 34 12 FE FF FF FF | 485 34 12 FE FF FF FF");
  drive.ask("305 0F 00 01 02 03 04");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_position>()), 0x04030201);
  drive.ask("405 1F 00 FF FF FF FF");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::target_velocity>()), -1);
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x1F);
  EXPECT_EQ(drive.ask("505"), "");
}

// shows 000.66, 000.306
TEST(Manual000, TakesSynchronousRpdosAtTheNextSync) {
  for (const std::uint32_t type : {0u, 1u, 240u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0) << type;
    drive.ask("080");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F) << type;
  }
}

// shows 000.67, 000.306
TEST(Manual000, TakesEventDrivenRpdosAtOnce) {
  for (const std::uint32_t type : {254u, 255u}) {
    Drive drive;
    write(drive, 0x1400, 2, 1, type);
    drive.ask(bench::start);
    drive.ask("205 0F 00");
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F) << type;
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

// shows 000.69, 000.174, 000.318
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
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(1s), "");
  drive.node.set<od::statusword>(canopen::raw(2));
  EXPECT_EQ(drive.ask("080"), "185 02 00");
}

// shows 000.72, 000.76, 000.233
TEST(Manual000, SendsEventDrivenTpdosAtAChangeAndByTheirTimer) {
  for (const std::uint32_t type : {254u, 255u}) {
    Drive drive;
    start_with(drive, 0x1800, type, 100);
    drive.node.set<od::statusword>(canopen::raw(0x37));
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
  drive.node.set<od::statusword>(canopen::raw(1));
  EXPECT_EQ(drive.pass(9999us), "");
  EXPECT_EQ(drive.pass(1us), "185 01 00");
}

// shows 000.96, 000.97
TEST(Manual000, TakesLongerRpdosAndNoShorterOnes) {
  Drive drive;
  start_with(drive, 0x1800, 255);
  EXPECT_EQ(drive.ask("205 0F"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0);
  EXPECT_EQ(drive.ask("205 1F 00 AA BB"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x1F);
}

// Mapping

// shows 000.86, 000.91, 000.206
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
    drive.node.set<od::statusword>(canopen::raw(0x0605));
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
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::controlword>()), 0x0F) << dummy;
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

}  // namespace
