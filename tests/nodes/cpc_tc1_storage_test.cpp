/// The runnable servo drive cpc TC1: what each sub-index of 1010h and 1011h stores and restores (manual 000, chapter
/// 12).
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cpc_tc1_bench.hpp"
#include "manuals/manual_bench.hpp"

namespace {

using namespace cpc_tc1_bench;
using namespace std::chrono_literals;

constexpr std::uint32_t hardware_error = 0x0606'0000;
constexpr std::uint32_t device_state = 0x0800'0022;

/// The values of the six parts: 1 to 6 are sub-indices.
struct Parts {
  bool communication, application, rs232, program, error_mapping;
  friend bool operator==(const Parts&, const Parts&) = default;
};

/// Sets all parts to values other than the defaults.
void change(QuietServo& drive) {
  EXPECT_EQ(drive.ask("605 2B 15 10 00 64 00 00 00"), "585 60 15 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 7A 60 00 09 03 00 00"), "585 60 7A 60 00 00 00 00 00");  // 777
  EXPECT_EQ(drive.ask("605 23 FF 60 00 F0 D8 FF FF"), "585 60 FF 60 00 00 00 00 00");
  EXPECT_EQ(drive.input("rs232 9600"), "");
  EXPECT_EQ(drive.input("program 0x11 0x22 0x33"), "");
  EXPECT_EQ(drive.input("error-mapping-table 1 2"), "");
  EXPECT_EQ(drive.input("error-mapping on"), "");
}

/// Which parts have the values of `change`.
[[nodiscard]] Parts changed(QuietServo& drive) {
  const cpc_tc1_node::VendorValues& values = drive.app->vendor_values();
  const bool position = drive.ask("605 40 7A 60 00 00 00 00 00") == "585 43 7A 60 00 09 03 00 00";
  const bool velocity = drive.ask("605 40 FF 60 00 00 00 00 00") == "585 43 FF 60 00 F0 D8 FF FF";
  EXPECT_EQ(position, velocity);
  const bool mapping = drive.ask("605 40 02 10 00 00 00 00 00") == "585 43 02 10 00 50 02 11 01";
  EXPECT_EQ(mapping, (values.error_mapping == std::vector<std::uint8_t>{1, 2}));
  return {.communication = drive.ask("605 40 15 10 00 00 00 00 00") == "585 4B 15 10 00 64 00 00 00",
          .application = position,
          .rs232 = values.rs232_rate == 9'600,
          .program = values.program == std::vector<std::uint8_t>{0x11, 0x22, 0x33},
          .error_mapping = mapping};
}

struct Row {
  std::uint8_t sub_index;
  Parts stored;
};
constexpr Row rows[] = {
    {1, {true, true, true, true, true}},     {2, {true, false, false, false, false}},
    {3, {false, true, false, false, false}}, {4, {false, false, true, false, false}},
    {5, {false, false, false, true, false}}, {6, {false, false, false, false, true}},
};
constexpr Parts all{true, true, true, true, true};
constexpr Parts none{};

// shows 000.137, 000.138, 000.158, 000.266, 000.352
TEST(CpcTc1Storage, EachSubIndexSavesItsParameters) {
  for (const auto& [sub_index, stored] : rows) {
    SCOPED_TRACE(sub_index);
    QuietServo drive;
    change(drive);
    EXPECT_EQ(changed(drive), all);
    EXPECT_EQ(drive.save(sub_index), manual::taken(0x1010, sub_index));
    drive.power_cycle();
    EXPECT_EQ(changed(drive), stored);
  }
}

// shows 000.137, 000.139, 000.140, 000.270
TEST(CpcTc1Storage, EachSubIndexRestoresItsParametersWithTheNextReset) {
  for (const auto& [sub_index, restored] : rows) {
    SCOPED_TRACE(sub_index);
    QuietServo drive;
    change(drive);
    EXPECT_EQ(drive.save(1), manual::taken(0x1010, 1));
    EXPECT_EQ(drive.load(sub_index), manual::taken(0x1011, sub_index));
    EXPECT_EQ(changed(drive), all);
    EXPECT_EQ(drive.ask(bench::reset_node), "705 00");
    const Parts kept{!restored.communication, !restored.application, !restored.rs232, !restored.program,
                     !restored.error_mapping};
    EXPECT_EQ(changed(drive), kept);
    drive.power_cycle();
    EXPECT_EQ(changed(drive), kept);
  }
}

// shows 000.141, 000.266, 000.270
TEST(CpcTc1Storage, EachSubIndexReads1) {
  QuietServo drive;
  for (std::uint8_t sub_index = 1; sub_index <= 6; ++sub_index) {
    for (const std::uint16_t index : {std::uint16_t{0x1010}, std::uint16_t{0x1011}}) {
      EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, index, sub_index, 0)),
                manual::sdo("585", 0x43, index, sub_index, 0x0000'0001));
    }
  }
}

// shows 000.138, 000.139
TEST(CpcTc1Storage, RejectsAWrongSignatureForEachSubIndex) {
  for (std::uint8_t sub_index = 1; sub_index <= 6; ++sub_index) {
    const std::string place = " 0" + std::to_string(sub_index);
    QuietServo drive;
    change(drive);
    EXPECT_EQ(drive.ask("605 23 10 10" + place + " 73 61 76 64"), manual::refused(0x1010, sub_index, device_state));
    EXPECT_EQ(drive.ask("605 23 10 10" + place + " 6C 6F 61 64"), manual::refused(0x1010, sub_index, device_state));
    EXPECT_EQ(drive.ask("605 23 11 10" + place + " 73 61 76 65"), manual::refused(0x1011, sub_index, device_state));
    drive.power_cycle();
    EXPECT_EQ(changed(drive), none);
  }
}

// shows 000.138, 000.139
TEST(CpcTc1Storage, ReportsAFailureOfTheMemoryForEachSubIndex) {
  for (std::uint8_t sub_index = 1; sub_index <= 6; ++sub_index) {
    QuietServo drive;
    change(drive);
    EXPECT_EQ(drive.save(1), manual::taken(0x1010, 1));
    EXPECT_EQ(drive.input("memory bad"), "");
    EXPECT_EQ(drive.save(sub_index), manual::refused(0x1010, sub_index, hardware_error));
    EXPECT_EQ(drive.load(sub_index), manual::refused(0x1011, sub_index, hardware_error));
    EXPECT_EQ(drive.input("memory good"), "");
    drive.power_cycle();
    EXPECT_EQ(changed(drive), all);
  }
}

// shows 000.20
TEST(CpcTc1Storage, EachSubIndexIsRejectedWhileTheMotorIsOn) {
  Servo drive;
  drive.enable();
  for (std::uint8_t sub_index = 1; sub_index <= 6; ++sub_index) {
    const std::string place = " 0" + std::to_string(sub_index);
    EXPECT_EQ(drive.ask("605 23 10 10" + place + " 73 61 76 65"), manual::refused(0x1010, sub_index, device_state));
    EXPECT_EQ(drive.ask("605 23 11 10" + place + " 6C 6F 61 64"), manual::refused(0x1011, sub_index, device_state));
  }
}

// shows 000.352
TEST(CpcTc1Storage, TheControlwordIsACommandAndNotStored) {
  QuietServo drive;
  EXPECT_EQ(drive.ask("605 2B 40 60 00 06 00 00 00"), "585 60 40 60 00 00 00 00 00");
  EXPECT_EQ(drive.save(1), manual::taken(0x1010, 1));
  drive.power_cycle();
  EXPECT_EQ(drive.ask("605 40 40 60 00 00 00 00 00"), "585 4B 40 60 00 00 00 00 00");
}

TEST(CpcTc1Storage, AResetCommunicationKeepsTheDataThatAreNotObjects) {
  QuietServo drive;
  change(drive);
  EXPECT_EQ(drive.ask(bench::reset_communication), "705 00");
  const Parts expected{
      .communication = false, .application = true, .rs232 = true, .program = true, .error_mapping = true};
  EXPECT_EQ(changed(drive), expected);
  EXPECT_EQ(drive.ask(bench::reset_node), "705 00");
  EXPECT_EQ(changed(drive), none);
}

TEST(CpcTc1Storage, AnotherProcessFindsTheStoredData) {
  const std::string store = testing::TempDir() + "cpc_tc1_data";
  const auto remove = [&] {
    for (const char* suffix : {"", ".application", ".lss"}) std::filesystem::remove(store + suffix);
  };
  remove();
  {
    bench::NodeBench<cpc_tc1_node::CpcTc1> drive{canopen::NodeId{5}, store};
    drive.input("program 1 2 3 4");
    drive.input("rs232 19200");
    EXPECT_EQ(drive.ask("605 23 10 10 01 73 61 76 65"), manual::taken(0x1010, 1));
  }
  bench::NodeBench<cpc_tc1_node::CpcTc1> again{canopen::NodeId{5}, store};
  EXPECT_EQ(again.app->vendor_values().program, (std::vector<std::uint8_t>{1, 2, 3, 4}));
  EXPECT_TRUE(again.logged("RS-232 19200 bit/s, program 4 bytes, error mapping off, 0 bytes"));
  remove();
}

// shows 000.41
TEST(CpcTc1Storage, AStoredHeartbeatTimeStartsTheHeartbeatWithTheBootUpMessage) {
  QuietServo drive;
  EXPECT_EQ(drive.ask("605 2B 17 10 00 F4 01 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(drive.save(2), manual::taken(0x1010, 2));
  EXPECT_EQ(drive.power_cycle(), "705 00");
  EXPECT_EQ(drive.pass(499ms), "");
  EXPECT_EQ(drive.pass(1ms), "705 7F");
}

// shows 000.106, 000.144, 000.219
TEST(CpcTc1Storage, APowerCycleRestartsTheDrive) {
  Servo drive;
  drive.enable();
  drive.input("fault 0x2310 0x02");
  EXPECT_EQ(drive.power_cycle(), "705 00");
  EXPECT_EQ(drive.app->node().state(), canopen::NmtState::pre_operational);
  EXPECT_EQ(drive.pass(1s), "");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 00 12 01 00 00 00 00"), "585 43 00 12 01 05 06 00 00");
  EXPECT_EQ(drive.ask("605 40 00 12 02 00 00 00 00"), "585 43 00 12 02 85 05 00 00");
}

}  // namespace
