/// The runnable servo drive without modes of operation: the statements of manual 000 about its application.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "cpc_tc1_bench.hpp"

namespace {

using namespace cpc_tc1_bench;
using namespace std::chrono_literals;

TEST(CpcTc1Node, TellsItsStatewordInTpdo1) {
  Servo drive;
  EXPECT_EQ(drive.ask("205 06 00").substr(0, 9), "185 31 02");
  EXPECT_EQ(drive.ask("205 07 00").substr(0, 9), "185 33 02");
  EXPECT_EQ(drive.ask("205 0F 00").substr(0, 9), "185 37 06");
}

// shows 000.148
TEST(CpcTc1Node, HasItsStatuswordAndMoreIn1002h) {
  Servo drive;
  EXPECT_EQ(drive.status(), 0x0101'0250u);  // 16: external enable, 24: stationary
  drive.enable();
  EXPECT_EQ(drive.ask("605 40 02 10 00 00 00 00 00"), "585 43 02 10 00 37 06 07 01");  // 17, 18: motor on, phase found
  drive.ask("305 1F 00 00 00 01 00");
  drive.pass(100ms);
  EXPECT_EQ(drive.status(), 0x0007'1237u);  // the motor turns
  drive.pass(2s);
  EXPECT_EQ(drive.status() & 0xFFFF, drive.statusword());
  EXPECT_EQ(drive.status(), 0x0107'1637u);
  drive.ask("205 06 00");
  EXPECT_EQ(drive.status(), 0x0105'0231u);
  drive.input("enable off");
  EXPECT_EQ(drive.status(), 0x0104'0231u);
}

TEST(CpcTc1Node, PositionsRunsAndFollowsInTheModeThatIsSelected) {
  Servo drive;
  drive.enable();
  drive.ask("305 1F 00 10 27 00 00");
  drive.pass(2s);
  EXPECT_EQ(drive.app->axis().position(), 10'000);
  drive.input("mode 3");
  drive.ask("405 0F 00 E8 03 00 00");
  drive.pass(1s);
  EXPECT_EQ(drive.app->axis().velocity(), 1'000);
  EXPECT_EQ(drive.input("mode 6"), "?");  // the drive does not have 6098h
}

TEST(CpcTc1Node, StopsWhenItsEnableInputFalls) {
  Servo drive;
  drive.input("mode 3");
  drive.enable();
  drive.ask("405 0F 00 00 00 01 00");
  drive.pass(1s);
  drive.input("enable off");
  EXPECT_EQ(drive.app->drive().state(), State::quick_stop_active);
  drive.pass(1s);
  EXPECT_EQ(drive.app->drive().state(), State::switch_on_disabled);
  EXPECT_EQ(drive.app->axis().velocity(), 0);
}

// shows 000.82
TEST(CpcTc1Node, KeepsTheCanIdOfATpdoWhileItIsValidAndItsBits29And30) {
  Servo drive;  // Operational
  constexpr auto refused = "585 80 00 18 01 30 00 09 06";
  constexpr auto taken = "585 60 00 18 01 00 00 00 00";
  EXPECT_EQ(drive.ask("605 23 00 18 01 86 01 00 40"), refused);  // a different CAN-ID
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 60"), refused);  // bit 29
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 00"), refused);  // bit 30
  EXPECT_NE(drive.ask("205 06 00").find("185 31 02"), std::string::npos);
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 C0"), taken);
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 E0"), refused);
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 80"), refused);  // bit 30 is always 1
  EXPECT_EQ(drive.ask("205 07 00").find("185 33 02"), std::string::npos);
  EXPECT_EQ(drive.ask("605 23 00 18 01 85 01 00 40").substr(0, 27), taken);
  EXPECT_NE(drive.ask("205 06 00").find("185 31 02"), std::string::npos);
}

// shows 000.20
TEST(CpcTc1Node, StoresAndRestoresNothingWhileTheMotorIsOn) {
  Servo drive;
  drive.enable();
  EXPECT_EQ(drive.ask("605 23 10 10 01 73 61 76 65"), "585 80 10 10 01 22 00 00 08");
  EXPECT_EQ(drive.ask("605 23 11 10 01 6C 6F 61 64"), "585 80 11 10 01 22 00 00 08");
  drive.ask("205 06 00");
  EXPECT_EQ(drive.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
}

TEST(CpcTc1Node, KeepsWhatIsStoredOverAPowerCycle) {
  Servo drive;
  drive.ask("605 2B 17 10 00 F4 01 00 00");
  drive.ask("605 23 10 10 01 73 61 76 65");
  drive.power_cycle();
  EXPECT_EQ(drive.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 F4 01 00 00");
  drive.ask("605 23 11 10 01 6C 6F 61 64");
  drive.power_cycle();
  EXPECT_EQ(drive.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 18 10 04 00 00 00 00"), "585 43 18 10 04 34 12 01 15");  // its serial number
}

// shows 000.149, 000.184
TEST(CpcTc1Node, SendsItsDataSheetFrom1021hAsText) {  // chapter 11; 12, 1021h and 1022h
  std::ifstream file{EDSC_EDS_DIR "/cpc-tc1.eds", std::ios::binary};
  const std::string expected{std::istreambuf_iterator<char>{file}, {}};
  ASSERT_FALSE(expected.empty());
  bench::NodeBench<cpc_tc1_node::CpcTc1> drive;
  EXPECT_EQ(drive.ask("605 40 22 10 00 00 00 00 00"), "585 4F 22 10 00 00 00 00 00");  // text, not compressed
  const canopen::Frame initiated = bench::frame(drive.ask("605 40 21 10 00 00 00 00 00"));
  EXPECT_EQ(initiated.data[0], 0x41);
  EXPECT_EQ(initiated.data[4] | initiated.data[5] << 8, static_cast<int>(expected.size()));
  std::string text;
  for (bool toggle = false, last = false; !last && text.size() <= expected.size(); toggle = !toggle) {
    const canopen::Frame segment =
        bench::frame(drive.ask(toggle ? "605 70 00 00 00 00 00 00 00" : "605 60 00 00 00 00 00 00 00"));
    ASSERT_EQ(segment.data[0] & 0xF0, toggle ? 0x10 : 0x00);
    last = (segment.data[0] & 1) != 0;
    text.append(segment.data.begin() + 1, segment.data.end() - (segment.data[0] >> 1 & 7));
  }
  EXPECT_EQ(text, expected);
}

constexpr auto lss_waiting = "7E5 04 00 00 00 00 00 00 00";
constexpr auto lss_configuration = "7E5 04 01 00 00 00 00 00 00";
constexpr auto lss_inquire_node_id = "7E5 5E 00 00 00 00 00 00 00";

// shows 000.151
TEST(CpcTc1Node, GetsItsNodeIdAndItsBitRateByLssAndKeepsThem) {  // chapter 13; CiA 305
  const std::string store = testing::TempDir() + "cpc_tc1_lss";
  for (const char* suffix : {"", ".application", ".lss"}) std::filesystem::remove(store + suffix);
  bench::NodeBench<cpc_tc1_node::CpcTc1> drive{canopen::NodeId{5}, store};
  EXPECT_EQ(drive.boot_up, "705 00");
  EXPECT_EQ(drive.ask(lss_configuration), "");
  EXPECT_EQ(drive.ask(lss_inquire_node_id), "7E4 5E 05 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("7E5 5A 00 00 00 00 00 00 00").substr(0, 6), "7E4 5A");          // vendor-ID
  EXPECT_EQ(drive.ask("7E5 5D 00 00 00 00 00 00 00"), "7E4 5D 34 12 01 15 00 00 00");  // 1018h:04
  EXPECT_EQ(drive.ask("7E5 11 2A 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask("7E5 13 00 04 00 00 00 00 00"), "7E4 13 00 00 00 00 00 00 00");  // 125 kbit/s
  EXPECT_EQ(drive.ask("7E5 17 00 00 00 00 00 00 00"), "7E4 17 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask(lss_waiting), "");
  EXPECT_TRUE(drive.logged("LSS: node-ID 42, 125 kbit/s stored"));
  EXPECT_EQ(drive.power_cycle(), "72A 00");
  bench::NodeBench<cpc_tc1_node::CpcTc1> again{std::nullopt, store};  // a new process
  EXPECT_EQ(again.boot_up, "72A 00");
  for (const char* suffix : {"", ".application", ".lss"}) std::filesystem::remove(store + suffix);
}

// shows 000.286
TEST(CpcTc1Node, TheMasterSelectsItByItsIdentityAndAssignsANodeId) {
  bench::NodeBench<cpc_tc1_node::CpcTc1> drive;
  EXPECT_EQ(drive.ask("7E5 40 F5 03 00 00 00 00 00"), "");                             // 1018h:01
  EXPECT_EQ(drive.ask("7E5 41 01 00 00 00 00 00 00"), "");                             // 1018h:02
  EXPECT_EQ(drive.ask("7E5 42 01 00 00 00 00 00 00"), "");                             // 1018h:03
  EXPECT_EQ(drive.ask("7E5 43 34 12 01 15 00 00 00"), "7E4 44 00 00 00 00 00 00 00");  // 1018h:04
  EXPECT_EQ(drive.ask("7E5 11 2A 00 00 00 00 00 00"), "7E4 11 00 00 00 00 00 00 00");
  EXPECT_EQ(drive.ask(lss_waiting), "");
  EXPECT_EQ(drive.ask("000 82 05"), "72A 00");
}

// shows 000.150, 000.350
TEST(CpcTc1Node, TakesTheBitRatesOfChapter13AndNoOther) {
  bench::NodeBench<cpc_tc1_node::CpcTc1> drive;
  drive.ask(lss_configuration);
  struct Row {
    int index;         ///< in table 0 of CiA 305
    const char* rate;  ///< null: not in the manual
  };
  for (const Row& row : {Row{0, "1000"}, Row{1, "800"}, Row{2, "500"}, Row{3, "250"}, Row{4, "125"}, Row{5, nullptr},
                         Row{6, "50"}, Row{7, "20"}, Row{8, "10"}, Row{9, nullptr}}) {
    SCOPED_TRACE(row.index);
    const std::string index = "0" + std::to_string(row.index);
    EXPECT_EQ(drive.ask("7E5 13 00 " + index + " 00 00 00 00 00"),
              row.rate != nullptr ? "7E4 13 00 00 00 00 00 00 00" : "7E4 13 01 00 00 00 00 00 00");
    if (row.rate == nullptr) continue;
    EXPECT_TRUE(drive.logged("LSS: " + std::string{row.rate} + " kbit/s is pending"));
  }
}

TEST(CpcTc1Node, ReportsAFaultAndForgetsItWithAReset) {
  Servo drive;
  drive.enable();
  EXPECT_EQ(drive.input("fault 0x3210 0x04").substr(0, 27), "085 10 32 05 00 00 00 00 00");
  EXPECT_EQ(drive.app->drive().state(), State::fault);
  drive.ask(bench::reset_node);
  EXPECT_EQ(drive.app->drive().state(), State::switch_on_disabled);
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 00 00 00 00");
}

}  // namespace
