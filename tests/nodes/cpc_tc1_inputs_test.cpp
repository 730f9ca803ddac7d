/// The runnable servo drive cpc TC1: its inputs, and what manual 000 makes observable of them.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "cpc_tc1_bench.hpp"
#include "manuals/manual_bench.hpp"

namespace {

using namespace cpc_tc1_bench;
using namespace std::chrono_literals;

constexpr auto read_status = "605 40 02 10 00 00 00 00 00";

// shows 000.148
TEST(CpcTc1Inputs, HomeErrorMappingAndAuxiliaryCommandAreBits19To21Of1002h) {
  QuietServo drive;
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 01 01");
  EXPECT_EQ(drive.input("home-position 500"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 09 01");
  EXPECT_EQ(drive.ask("605 40 64 60 00 00 00 00 00"), "585 43 64 60 00 F4 01 00 00");
  EXPECT_EQ(drive.input("error-mapping on"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 19 01");
  EXPECT_EQ(drive.input("auxiliary 0"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 39 01");
  EXPECT_EQ(drive.input("home-position lost"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 31 01");
  EXPECT_EQ(drive.input("error-mapping off"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 21 01");
  EXPECT_EQ(drive.input("auxiliary off"), "");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 01 01");
}

TEST(CpcTc1Inputs, APowerCycleLosesTheHomePosition) {
  QuietServo drive;
  drive.input("home-position 0");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 09 01");
  drive.power_cycle();
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 01 01");
}

// shows 000.148
TEST(CpcTc1Inputs, TheAuxiliaryCommandIsAddedInEachMode) {
  Servo drive;
  drive.input("auxiliary 1000");
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().position(), 0);  // the motor is off
  drive.enable();
  drive.pass(1s);
  EXPECT_NEAR(drive.app->axis().position(), 1'000, 5);
  EXPECT_EQ(drive.read("02 10 00"), "37 02 27 00");  // it turns: bit 24 is 0
  drive.ask("305 1F 00 10 27 00 00");                // to 10000
  drive.pass(2s);
  EXPECT_NEAR(drive.app->axis().position(), 10'000 + 3'000, 10);
  drive.input("auxiliary -500");
  drive.input("mode 3");
  drive.ask("405 0F 00 D0 07 00 00");  // 2000 increments per second
  drive.pass(1s);
  EXPECT_EQ(drive.read("6C 60 00"), "DC 05 00 00");  // 1500
  drive.input("auxiliary off");
  drive.pass(100ms);
  EXPECT_EQ(drive.read("6C 60 00"), "D0 07 00 00");
}

TEST(CpcTc1Inputs, ALimitSwitchAndAQuickStopEndTheAuxiliaryMotion) {
  Servo drive;
  drive.enable();
  drive.input("auxiliary 1000");
  drive.pass(100ms);
  EXPECT_EQ(drive.app->axis().velocity(), 1'000);
  drive.input("limit positive on");
  EXPECT_EQ(drive.app->axis().velocity(), 0);
  drive.input("limit positive off");
  EXPECT_EQ(drive.app->axis().velocity(), 1'000);
  drive.input("enable off");
  EXPECT_EQ(drive.app->axis().velocity(), 0);
}

// shows 000.148
TEST(CpcTc1Inputs, ExternalEnableIsBit16Of1002h) {
  QuietServo drive;
  drive.input("enable off");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 00 01");
  drive.input("enable on");
  EXPECT_EQ(drive.ask(read_status), "585 43 02 10 00 50 02 01 01");
}

// shows 000.354
TEST(CpcTc1Inputs, Bit24Of1002hIsSpeedIsZeroOfProfileVelocityMode) {
  Servo drive;
  drive.input("mode 3");
  drive.enable();
  for (const char* target : {"E8 03 00 00", "00 00 00 00", "18 FC FF FF", "00 00 00 00"}) {  // 1000, 0, -1000, 0
    drive.ask("405 0F 00 " + std::string{target});
    drive.pass(1s);
    const bool rests = drive.app->axis().velocity() == 0;
    EXPECT_EQ(rests, std::string{target} == "00 00 00 00");
    EXPECT_EQ((drive.statusword() & 0x1000) != 0, rests);
    EXPECT_EQ((drive.status() & 0x0100'0000) != 0, rests);
    EXPECT_EQ(drive.status() & 0xFEC0'0000, 0u);  // reserved bits
  }
}

// shows 000.103, 000.105, 000.108
TEST(CpcTc1Inputs, AnErrorThatIsGoneLeavesTheRegisterAndTheBytesOfTheOther) {
  QuietServo drive;
  EXPECT_EQ(drive.input("fault 0x2310 0x02 0x11 0x22"), "085 10 23 03 11 22 00 00 00");
  EXPECT_EQ(drive.input("fault 0x3210 0x04 1 2 3 4 5"), "085 10 32 07 01 02 03 04 05");
  EXPECT_EQ(drive.input("fault-over 0x04"), "085 00 00 03 11 22 00 00 00");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 03 00 00 00");
  EXPECT_EQ(drive.input("fault-over 0x02"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 00 00 00 00");
  EXPECT_EQ(drive.input("fault-over 0x02"), "");
  EXPECT_EQ(drive.input("fault 0x3210 0x04 1 2 3 4 5 6"), "?");
}

// shows 000.30, 000.32
TEST(CpcTc1Inputs, FollowsNmtCommandsByLocalControl) {
  QuietServo drive;
  EXPECT_EQ(drive.ask("605 2B 17 10 00 0A 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(drive.input("nmt stop"), "");
  EXPECT_EQ(drive.pass(10ms), "705 04");
  EXPECT_EQ(drive.input("nmt pre-operational"), "");
  EXPECT_EQ(drive.pass(10ms), "705 7F");
  EXPECT_EQ(drive.input("nmt start").substr(0, 9), "185 50 02");
  EXPECT_NE(drive.pass(10ms).find("705 05"), std::string::npos);
  EXPECT_EQ(drive.input("nmt reset-communication"), "705 00");
  EXPECT_EQ(drive.input("nmt reset-node"), "705 00");
  EXPECT_EQ(drive.input("nmt sleep"), "?");
}

// shows 000.151, 000.333, 000.349
TEST(CpcTc1Inputs, TheVendorsSoftwareSetsThePersistentNodeIdAndBitRate) {
  QuietServo drive;
  EXPECT_EQ(drive.input("node-id 42"), "");
  EXPECT_TRUE(drive.logged("LSS: node-ID 42, 1000 kbit/s stored"));
  for (const char* rate : {"800", "500", "250", "125", "50", "20", "10", "1000"}) {
    EXPECT_EQ(drive.input("baud " + std::string{rate} + "000"), "");
    EXPECT_TRUE(drive.logged("LSS: node-ID 42, " + std::string{rate} + " kbit/s stored")) << rate;
  }
  for (const char* line : {"node-id 0", "node-id 128", "baud 100000", "baud 500", "baud 0"}) {
    EXPECT_EQ(drive.input(line), "?") << line;
  }
  EXPECT_EQ(drive.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 00 00 00");  // until then node 5
  EXPECT_EQ(drive.power_cycle(), "72A 00");
}

}  // namespace
