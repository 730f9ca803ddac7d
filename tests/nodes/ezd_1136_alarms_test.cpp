/// The runnable stepper drive: the statements of manual 001 about alarms and warnings.
#include "ezd_1136/ezd_1136.hpp"

#include <gtest/gtest.h>

#include <string>

#include "ezd_1136_bench.hpp"
#include "node_bench.hpp"

namespace {

using canopen::cia402::State;
using ezd_1136_bench::Stepper;
namespace od = ezd_1136::od;
using namespace std::chrono_literals;

struct AlarmRow {
  const char* line;
  const char* emergency;
  const char* lamp;
};

// shows 001.44, 001.45, 001.109, 001.146, 001.158, 001.193, 001.223
TEST(Ezd1136Node, SendsAnAlarmAsTheLowByteOfItsCode) {
  constexpr AlarmRow rows[] = {
      {"alarm 10", "085 0A 00 03 00 00 00 00 00", "LED 1 green + 1 red"},
      {"alarm 11", "085 0B 00 03 00 00 00 00 00", "LED 1 green + 2 red"},
      {"alarm 12", "085 0C 00 03 00 00 00 00 00", "LED 1 green + 1 red"},
      {"alarm 13", "085 0D 00 05 00 00 00 00 00", "LED 1 green + 4 red"},
      {"alarm 14", "085 0E 00 05 00 00 00 00 00", "LED 1 green + 3 red"},
      {"alarm 15", "085 0F 00 09 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 16", "085 10 00 81 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 20", "085 14 00 81 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 24", "085 18 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 25", "085 19 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 26", "085 1A 00 21 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 50", "085 32 00 11 00 00 00 00 00", "LED 1 green + 5 red"},
      {"alarm 100", "085 64 00 11 00 00 00 00 00", "LED 1 green + 5 red"},
  };
  for (const AlarmRow& row : rows) {
    SCOPED_TRACE(row.line);
    Stepper drive;
    const std::string code = std::string{row.emergency}.substr(4, 5);
    EXPECT_EQ(drive.input(row.line), std::string{row.emergency} + " | 185 18 02 " + code + " 01");
    EXPECT_EQ(drive.state(), State::fault);
    EXPECT_TRUE(drive.logged(row.lamp));
    EXPECT_EQ(drive.get<od::drive_error_code>(), drive.get<od::error_code>());
    EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 " + code + " 01");
    EXPECT_TRUE(drive.logged("LED green flashing"));
    EXPECT_EQ(drive.get<od::drive_error_code>(), 0);
  }
  Stepper drive;
  EXPECT_EQ(drive.input("alarm 17"), "?");
}

// shows 001.44, 001.45, 001.145, 001.146
TEST(Ezd1136Node, AddsWarningsInTheHighByteOfTheCode) {
  Stepper drive;
  EXPECT_EQ(drive.input("warning 2048 on"), "085 00 08 81 00 00 00 00 00 | 185 50 02 00 08 01");
  EXPECT_TRUE(drive.logged("LED red steady"));
  EXPECT_EQ(drive.input("warning 4096 on"), "085 00 18 81 00 00 00 00 00 | 185 50 02 00 18 01");  // 6144
  EXPECT_EQ(drive.input("alarm 26"), "085 1A 18 A1 00 00 00 00 00 | 185 18 02 1A 18 01");
  EXPECT_EQ(drive.control(0x80), "085 00 00 81 00 00 00 00 00 | 185 50 02 1A 18 01");  // the warnings remain
  EXPECT_EQ(drive.input("warning 2048 off"), "085 00 00 81 00 00 00 00 00");
  EXPECT_EQ(drive.input("warning 4096 off"), "085 00 00 00 00 00 00 00 00");
  for (const char* bits : {"256", "512", "1024", "8192"}) {
    EXPECT_NE(drive.input("warning " + std::string{bits} + " on"), "?");
  }
  EXPECT_EQ(drive.get<od::drive_error_code>(), 256 + 512 + 1'024 + 8'192);
}

// shows 001.46, 001.95, 001.157
TEST(Ezd1136Node, RaisesAlarms13And14OutsideItsSupply) {
  Stepper drive;
  EXPECT_EQ(drive.input("supply 18"), "");
  EXPECT_EQ(drive.input("supply 60"), "");
  EXPECT_EQ(drive.get<od::bus_voltage>(), 6'000);
  EXPECT_EQ(drive.input("supply 17"), "085 0D 00 05 00 00 00 00 00 | 185 18 02 0D 00 01");
  EXPECT_EQ(drive.control(0x80), "");  // as long as the fault lasts
  drive.control(0x00);
  EXPECT_EQ(drive.input("supply 24"), "");
  EXPECT_EQ(drive.control(0x80), "085 00 00 00 00 00 00 00 00 | 185 50 02 0D 00 01");
  EXPECT_EQ(drive.input("supply 61"), "085 0E 00 05 00 00 00 00 00 | 185 18 02 0E 00 01");
}

// shows 001.48
TEST(Ezd1136Node, RaisesAlarm50WhenTheBusIsLostWhileEnabledAnd100WhenItIsStartedAgain) {
  Stepper drive;
  drive.ask("605 23 16 10 01 64 00 01 00");  // node 1 within 100 ms
  drive.ask("701 05");
  drive.enable();
  drive.pass(99ms);
  const std::string lost = drive.pass(2ms);
  EXPECT_NE(lost.find("085 30 81 11 00 00 00 00 00"), std::string::npos);  // the service's own EMCY
  EXPECT_NE(lost.find("085 32 00 11 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.state(), State::fault);
  drive.ask("701 05");
  drive.control(0x80);
  EXPECT_EQ(drive.state(), State::switch_on_disabled);
  EXPECT_NE(drive.ask(bench::start).find("085 64 00 11 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.state(), State::fault);
  Stepper not_enabled;
  not_enabled.ask("605 23 16 10 01 64 00 01 00");
  not_enabled.ask("701 05");
  EXPECT_EQ(not_enabled.pass(200ms).find("085 32"), std::string::npos);
}

// shows 001.49, 001.61, 001.62, 001.199
TEST(Ezd1136Node, WarnsAtItsLimits) {
  Stepper drive;
  EXPECT_EQ(drive.input("limit positive on"), "085 00 08 81 00 00 00 00 00 | 185 50 0B 00 08 01");  // bits 8 and 11
  EXPECT_EQ(drive.input("limit positive off"), "085 00 00 00 00 00 00 00 00 | 185 50 02 00 08 01");
  EXPECT_EQ(drive.input("limit negative on"), "085 00 10 81 00 00 00 00 00 | 185 50 0B 00 10 01");
  EXPECT_EQ(drive.input("limit negative off"), "085 00 00 00 00 00 00 00 00 | 185 50 02 00 10 01");
  // A software limit: only the warning.
  drive.set<od::software_position_limit<2>>(1'000);
  drive.enable();
  drive.set<od::target_position>(5'000);
  drive.control(0x3F);
  EXPECT_NE(drive.pass(1s).find("085 00 08 81 00 00 00 00 00"), std::string::npos);
  EXPECT_EQ(drive.get<od::position_actual_value>(), 1'000);
  EXPECT_EQ(drive.statusword(), 0x1637);
}

// shows 001.70
TEST(Ezd1136Node, HasA38hInTheLowByteOfAFault) {
  Stepper drive;
  drive.enable();
  EXPECT_EQ(drive.input("alarm 16"), "085 10 00 81 00 00 00 00 00 | 185 38 02 10 00 01");
}

// shows 001.45, 001.149
TEST(Ezd1136Node, RaisesAlarm25ForAPositionDeviation) {
  Stepper drive;
  drive.set<od::position_error_threshold>(1'000);
  drive.enable();
  drive.set<od::target_position>(100'000);
  drive.control(0x3F);
  drive.pass(100ms);
  drive.input("block on");
  EXPECT_NE(drive.pass(500ms).find("085 19 00 21 00 00 00 00 00"), std::string::npos);
}

}  // namespace
