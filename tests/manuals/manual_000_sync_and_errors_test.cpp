/// Manual 000, the servo drive cpc TC1: error control, EMCY and SYNC.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>
#include <string>

#include "manual_000_bench.hpp"
#include "manual_bench.hpp"

namespace {

using canopen::ErrorRegister;
using manual::refused;
using manual::taken;
using manual::write;
using manual_000::Drive;
using manual_000::start_with;
namespace od = cpc_tc1::od;
using namespace std::chrono_literals;

constexpr std::uint32_t invalid_value = 0x0609'0030;
constexpr std::uint32_t value_too_high = 0x0609'0031;

// Error control

// shows 000.44, 000.132, 000.221
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

// shows 000.100, 000.102, 000.104, 000.113, 000.115..000.117, 000.248
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

// shows 000.112, 000.152, 000.190, 000.243
TEST(Manual000, SetsTheGenericErrorWithEveryOther) {
  constexpr std::uint8_t bits[] = {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x80};
  for (const std::uint8_t bit : bits) {
    Drive drive;
    drive.node.emergency(0x1000, static_cast<ErrorRegister>(bit));
    drive.pass(0s);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::error_register>()), bit | 1);
  }
}

// SYNC

// shows 000.118, 000.121..000.123, 000.156, 000.157, 000.234, 000.237, 000.353
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

// shows 000.120, 000.252
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

// shows 000.126, 000.127, 000.165, 000.353
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

// shows 000.130, 000.275
TEST(Manual000, KeepsTheTimeOfTheLastSyncInMicroseconds) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 23 13 10 00 00 00 00 00"), "585 60 13 10 00 00 00 00 00");
  drive.pass(1234us);
  drive.ask("080");
  EXPECT_EQ(drive.ask("605 40 13 10 00 00 00 00 00"), "585 43 13 10 00 D2 04 00 00");
}

}  // namespace
