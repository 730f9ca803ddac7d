/// Manual 002, the servo drive CPD as node 5: error control and EMCY.
#include <gtest/gtest.h>

#include <cpd/device.hpp>

#include "manual_bench.hpp"
#include "support/omitting.hpp"

namespace {

using canopen::ErrorRegister;
using canopen::NmtState;
using manual::write;
namespace od = cpd::od;
using namespace std::chrono_literals;

using Drive = bench::Bench<cpd::Device>;

// Error control

// shows 002.54, 002.55, 002.199, 002.244
TEST(Manual002, AnswersEachGuardingRequestWithItsStateAndAToggleBit) {
  Drive drive;
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
  EXPECT_EQ(drive.pass(10s), "");
  EXPECT_EQ(drive.ask("705 R 1"), "705 FF");
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  drive.ask(bench::stop);
  EXPECT_EQ(drive.ask("705 R 1"), "705 84");
  EXPECT_EQ(drive.ask("705 R 1"), "705 04");
  drive.ask(bench::reset_communication);
  EXPECT_EQ(drive.ask("705 R 1"), "705 7F");
}

// shows 002.56, 002.197, 002.245
TEST(Manual002, TellsThatTheMasterIsMissing) {
  Drive drive;
  write(drive, 0x100C, 0, 2, 200);
  write(drive, 0x100D, 0, 1, 2);
  drive.ask(bench::start);
  EXPECT_EQ(drive.ask("705 R 1"), "705 05");
  EXPECT_EQ(drive.pass(399'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
  EXPECT_EQ(drive.node.state(), NmtState::pre_operational);
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 11 00 00 00");
  write(drive, 0x100D, 0, 1, 0);
  drive.pass(0s);
  drive.ask("705 R 1");
  EXPECT_EQ(drive.pass(10s), "");
}

// shows 002.98
TEST(Manual002, IsNotGuardedDuringItsInitialisation) {
  bench::RecordingBus bus;
  bench::NodeOf<cpd::Device, bench::RecordingBus> node{bus, canopen::NodeId{5}};
  node.on_frame(bench::frame("705 R 1"), {});
  EXPECT_EQ(bus.take(), "");
  node.start({});
  EXPECT_EQ(bus.take(), "705 00");
  node.on_frame(bench::frame("705 R 1"), {});
  EXPECT_EQ(bus.take(), "705 7F");
}

// shows 002.62
TEST(Manual002, IsNotGuardedWhileItHasAHeartbeat) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 17 10 00 E8 03 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
  EXPECT_EQ(drive.ask("705 R 1"), "");
  EXPECT_EQ(drive.pass(1s), "705 7F");
}

// shows 002.63, 002.64, 002.137
TEST(Manual002, WatchesTheHeartbeatOfTheNodeIn1016h) {
  Drive drive;
  write(drive, 0x1016, 1, 4, 0x0001'00C8);  // node 1, 200 ms
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199ms), "");
  EXPECT_EQ(drive.ask("701 05"), "");
  EXPECT_EQ(drive.pass(199'999us), "");
  EXPECT_EQ(drive.pass(1us), "085 30 81 11 00 00 00 00 00");
  Drive unused;
  write(unused, 0x1016, 1, 4, 0x0001'0000);
  EXPECT_EQ(unused.ask("701 05"), "");
  EXPECT_EQ(unused.pass(10s), "");
}

// shows 002.65
TEST(Manual002, GoesWhere1029hSaysWhenErrorControlFails) {
  struct Row {
    std::uint32_t behaviour;
    const char* command;
    NmtState after;
  };
  constexpr Row rows[] = {
      {0, bench::start, NmtState::pre_operational},
      {0, bench::stop, NmtState::stopped},
      {1, bench::start, NmtState::operational},
      {2, bench::start, NmtState::stopped},
      {2, bench::enter_pre_operational, NmtState::stopped},
  };
  for (const auto& [behaviour, command, after] : rows) {
    Drive drive;
    if (behaviour != 0) write(drive, 0x1029, 1, 1, behaviour);
    write(drive, 0x1016, 1, 4, 0x0001'00C8);
    drive.ask(command);
    drive.ask("701 05");
    drive.pass(200ms);
    EXPECT_EQ(drive.node.state(), after) << behaviour << ", " << command;
  }
}

// EMCY

// shows 002.237, 002.240
TEST(Manual002, CarriesTheErrorAndItsObjectInAnEmcy) {
  Drive drive;
  drive.node.emergency(0x8611, ErrorRegister::device_profile, {0x20, 0xA3, 0x65, 0x60, 0x00});
  EXPECT_EQ(drive.pass(0s), "085 11 86 21 20 A3 65 60 00");
  EXPECT_EQ(drive.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 21 00 00 00");
}

// shows 002.33, 002.239, 002.392
TEST(Manual002, TellsTheKindOfAnErrorInTheErrorRegister) {
  constexpr std::uint8_t bits[] = {0x10, 0x20, 0x80};
  for (const std::uint8_t bit : bits) {
    Drive drive;
    drive.node.emergency(0x1000, static_cast<ErrorRegister>(bit));
    drive.pass(0s);
    EXPECT_EQ(canopen::to_raw(drive.node.get<od::error_register>()), bit | 1);
  }
}

// shows 002.30, 002.31, 002.121, 002.122, 002.189, 002.396, 002.397, 002.554, 002.555
TEST(Manual002, KeepsFiveErrorsUntil0IsWritten) {
  Drive drive;
  for (std::uint16_t code = 0x1001; code <= 0x1006; ++code) {
    drive.node.emergency(code, ErrorRegister::current);
    drive.pass(0s);
  }
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 05 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 06 10 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 02 00 00 00 00"), "585 43 03 10 02 05 10 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 05 00 00 00 00"), "585 43 03 10 05 02 10 00 00");
  EXPECT_EQ(drive.ask("605 2F 03 10 00 01 00 00 00"), "585 80 03 10 00 30 00 09 06");
  EXPECT_EQ(drive.ask("605 2F 03 10 00 00 00 00 00"), "585 60 03 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
  for (std::uint8_t i = 1; i <= 5; ++i) {
    EXPECT_EQ(drive.ask(manual::sdo("605", 0x40, 0x1003, i, 0)), manual::sdo("585", 0x43, 0x1003, i, 0));
  }
  drive.node.emergency(0x8611, ErrorRegister::device_profile, {0x11, 0x86, 0x65, 0x60, 0x00});
  drive.pass(0s);
  EXPECT_EQ(drive.ask("605 40 03 10 01 00 00 00 00"), "585 43 03 10 01 11 86 00 00");
}

// shows 002.37
TEST(Manual002, KeepsTheInhibitTimeOfEmcy) {
  Drive drive;
  EXPECT_EQ(drive.ask("605 2B 15 10 00 64 00 00 00"), "585 60 15 10 00 00 00 00 00");  // 10 ms
  drive.node.emergency(0x2310, ErrorRegister::current);
  drive.node.emergency(0x3210, ErrorRegister::voltage);
  EXPECT_EQ(drive.pass(9999us), "085 10 23 03 00 00 00 00 00");
  EXPECT_EQ(drive.pass(1us), "085 10 32 07 00 00 00 00 00");
}

// shows 002.247, 002.248, 002.429, 002.430
TEST(Manual002, ProducesAHeartbeatWhileItMonitorsThreeNodes) {
  for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
    Drive drive;
    write(drive, 0x1017, 0, 2, 100);
    for (std::uint8_t entry = 1; entry <= 3; ++entry) {
      EXPECT_EQ(write(drive, 0x1016, entry, 4, std::uint32_t{entry} << 16 | 250), manual::taken(0x1016, entry));
    }
    drive.ask("701 05");
    drive.ask("702 05");
    drive.ask("703 05");
    EXPECT_EQ(drive.pass(200ms), "705 7F | 705 7F");
    for (const char* frame : {"701 05", "702 05", "703 05"}) {
      if (frame[2] != '0' + node) drive.ask(frame);  // this node is missing
    }
    EXPECT_EQ(drive.pass(60ms), "085 30 81 11 00 00 00 00 00");
    EXPECT_EQ(drive.pass(40ms), "705 7F");
    write(drive, 0x1017, 0, 2, 0);
    for (std::uint8_t entry = 1; entry <= 3; ++entry) write(drive, 0x1016, entry, 4, std::uint32_t{entry} << 16);
    drive.pass(0s);
    EXPECT_EQ(drive.pass(10s), "");
  }
}

}  // namespace
