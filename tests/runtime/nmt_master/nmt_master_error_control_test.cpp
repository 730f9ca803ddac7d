/// Error control by the NMT master: node guarding, heartbeats, and lost slaves.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "nmt_master_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::NmtSlave;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using master_bench::Host;
using master_bench::Network;
using master_bench::Slave;
namespace assignment = canopen::slave_assignment;
namespace start_up = canopen::nmt_start_up;
using namespace std::chrono_literals;

using Lines = std::vector<std::string>;

constexpr std::uint32_t guarded = (100u << 16) | (3u << 8);  ///< every 100 ms, lost after 300 ms

constexpr std::uint32_t plain = assignment::listed | assignment::boot;
constexpr std::uint32_t mandatory = plain | assignment::mandatory;

TEST(NmtMaster, GuardsASlaveAndComparesItsState) {
  Network network{{NmtSlave{NodeId{5}, plain | guarded}}, {}};
  network.with_error_control = true;
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(50ms),
            (Lines{"(network started)", "000 82 00", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "705 R 1", "705 7F", "(5 state 7F)", "(5 0)", "000 01 05"}));
  EXPECT_EQ(network.pass(100ms), (Lines{"705 R 1", "705 85", "(5 state 05)"}));
  EXPECT_EQ(network.master.state(NodeId{5}), NmtState::operational);
  EXPECT_EQ(network.pass(100ms), (Lines{"705 R 1", "705 05"}));
}

TEST(NmtMaster, TellsThatASlaveIsNotInTheStateItWasCommandedTo) {
  Network network{{NmtSlave{NodeId{5}, plain | guarded}}, {}};
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(150ms);
  VirtualBus::Endpoint& other = network.bus.attach();
  other.send(bench::frame("000 02 05"));
  EXPECT_EQ(network.pass(100ms), (Lines{"000 02 05", "(5 state 04)", "(5 unexpected state 04)"}));
}

TEST(NmtMaster, ComparesTheStateInHeartbeatsWithTheLastCommand) {
  NmtSlave slave{NodeId{5}, plain};
  slave.heartbeat_time = 100;
  Network network{{slave}, {}};
  network.slave(5, true).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(400ms);
  VirtualBus::Endpoint& other = network.bus.attach();
  other.send(bench::frame("000 02 05"));
  EXPECT_EQ(network.pass(100ms), (Lines{"000 02 05", "(5 state 04)", "(5 unexpected state 04)"}));
  EXPECT_TRUE(network.master.command(canopen::NmtCommand::start, NodeId{5}));
  EXPECT_EQ(network.pass(100ms), (Lines{"000 01 05", "(5 state 05)"}));
  EXPECT_TRUE(network.master.command(canopen::NmtCommand::stop, NodeId{5}));
  EXPECT_EQ(network.pass(100ms), (Lines{"000 02 05", "(5 state 04)"})) << "commanded";
  other.send(bench::frame("000 82 05"));
  const Lines reset = network.pass(200ms);
  EXPECT_EQ(std::ranges::count(reset, "(5 unexpected state 7F)"), 0) << "it is booted again";
}

TEST(NmtMaster, WaitsForTheHeartbeatBeforeTheStart) {
  NmtSlave slave{NodeId{5}, plain};
  slave.heartbeat_time = 100;
  Network network{{slave}, {}};
  network.with_error_control = true;
  network.slave(5, true).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(0ms),
            (Lines{"(network started)", "000 82 00", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "705 7F", "(5 state 7F)", "585 43 00 10 00 91 01 0F 00", "605 40 17 10 00 00 00 00 00",
                   "585 4B 17 10 00 32 00 00 00"}));
  EXPECT_EQ(network.pass(250ms), (Lines{"705 7F", "705 7F", "705 7F", "705 7F", "705 7F", "(5 0)", "000 01 05"}))
      << "their rate is measured";
  EXPECT_EQ(network.pass(50ms), (Lines{"705 05", "(5 state 05)"}));
}

TEST(NmtMaster, SetsTheHeartbeatOfASlaveThatHasNone) {
  NmtSlave slave{NodeId{5}, mandatory};
  slave.heartbeat_time = 100;
  Network network{{slave}, {}};
  Slave& device = network.slave(5, false);
  device.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(60ms),
            (Lines{"000 82 00", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "605 40 17 10 00 00 00 00 00", "585 4B 17 10 00 00 00 00 00",
                   "605 2B 17 10 00 32 00 00 00", "585 60 17 10 00 00 00 00 00", "(5 state 7F)"}));
  EXPECT_EQ(network.pass(250ms), (Lines{"(5 0)", "(network started)", "000 01 05", "(5 state 05)"}));
  device.switch_off();
  EXPECT_EQ(network.pass(1s).front(), "(5 lost 05)");
}

/// A master and a slave with a heartbeat time, until 1017h is read; the test writes the frames of the slave.
struct Asked {
  explicit Asked(std::uint16_t heartbeat_time) {
    slaves[0].heartbeat_time = heartbeat_time;
    master.start(TimePoint{});
    EXPECT_EQ(answer("705 00"), "000 82 00 | 605 40 00 10 00 00 00 00 00");
    EXPECT_EQ(answer("585 43 00 10 00 91 01 0F 00"), "605 40 17 10 00 00 00 00 00");
  }
  std::string answer(const std::string& text) {
    master.on_frame(bench::frame(text), now);
    return bus.take();
  }

  bench::RecordingBus bus;
  Lines log;
  TimePoint now{};
  std::array<NmtSlave, 1> slaves{NmtSlave{NodeId{5}, mandatory}};
  canopen::NmtMaster<bench::RecordingBus, 1, Host> master{bus, slaves, {}, 100ms, Host{&log}};
};

TEST(NmtMaster, LeavesAHeartbeatTimeThatIsShortEnough) {
  EXPECT_EQ(Asked{600}.answer("585 4B 17 10 00 90 01 00 00"), "") << "400 ms";
  EXPECT_EQ(Asked{600}.answer("585 4B 17 10 00 91 01 00 00"), "605 2B 17 10 00 2C 01 00 00") << "401 ms: 300 ms then";
  EXPECT_EQ(Asked{600}.answer("585 4B 17 10 00 00 00 00 00"), "605 2B 17 10 00 2C 01 00 00");
  EXPECT_EQ(Asked{1}.answer("585 4B 17 10 00 00 00 00 00"), "605 2B 17 10 00 01 00 00 00");
  EXPECT_EQ(Asked{600}.answer("585 80 17 10 00 01 00 01 06"), "605 2B 17 10 00 2C 01 00 00") << "write-only";
}

TEST(NmtMaster, ASlaveWithoutItsHeartbeatIsNotStarted) {
  Asked plant{100};
  EXPECT_EQ(plant.answer("585 4B 17 10 00 32 00 00 00"), "");
  plant.master.on_time(TimePoint{99ms});
  EXPECT_EQ(plant.log, (Lines{"(5 boot-up 00)"}));
  plant.master.on_time(TimePoint{100ms});
  EXPECT_EQ(plant.log, (Lines{"(5 boot-up 00)", "(5 K)"}));
  EXPECT_FALSE(plant.master.network_started());
  EXPECT_EQ(plant.bus.take(), "");
}

TEST(NmtMaster, ASlaveThatCannotHaveAHeartbeatIsNotStarted) {
  Asked plant{100};
  plant.answer("585 80 17 10 00 00 00 02 06");
  EXPECT_EQ(plant.answer("585 80 17 10 00 00 00 02 06"), "");
  EXPECT_EQ(plant.log, (Lines{"(5 boot-up 00)", "(5 K)"}));
}

TEST(NmtMaster, ASlaveThatDoesNotAnswerGuardingIsNotStarted) {
  Network network{{NmtSlave{NodeId{5}, mandatory | guarded}}, {}};
  network.with_error_control = true;
  network.slave(5, true).switch_on();  // with a heartbeat it does not answer guarding
  network.devices.front().switch_off();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.bus.attach().send(bench::frame("705 00"));
  network.pass(0ms);
  network.bus.attach().send(bench::frame("585 43 00 10 00 91 01 0F 00"));
  EXPECT_EQ(network.pass(299ms), (Lines{"585 43 00 10 00 91 01 0F 00", "705 R 1", "705 R 1", "705 R 1"}));
  EXPECT_EQ(network.pass(1s), (Lines{"(5 lost 00)", "(5 F)"}));
}

TEST(NmtMaster, ASlaveThatIsOperationalAlreadyMayBeKeptAlive) {
  NmtSlave alive{NodeId{5}, plain | assignment::keep_alive};
  alive.heartbeat_time = 100;
  Network network{{alive, NmtSlave{NodeId{6}, plain}}, {}};
  Slave& device = network.slave(5, true);
  device.switch_on();
  network.bus.attach().send(bench::frame("000 01 05"));
  network.pass(10ms);
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(100ms), (Lines{"(network started)", "000 82 06", "605 40 00 10 00 00 00 00 00",
                                        "585 43 00 10 00 91 01 0F 00", "(5 state 05)", "(5 L)"}));
  EXPECT_EQ(device.state(), NmtState::operational);
}

TEST(NmtMaster, ASlaveToBeKeptAliveThatIsNotOperationalIsReset) {
  NmtSlave alive{NodeId{5}, plain | assignment::keep_alive | guarded};
  Network network{{alive}, {}};
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(20ms),
            (Lines{"(network started)", "605 40 00 10 00 00 00 00 00", "585 43 00 10 00 91 01 0F 00", "(5 state 7F)",
                   "000 82 05", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "(5 state 7F)", "(5 0)", "000 01 05"}));
}

TEST(NmtMaster, ASlaveToBeKeptAliveIsNotResetWhileItsStateIsUnknown) {
  NmtSlave alive{NodeId{5}, mandatory | assignment::keep_alive};
  alive.heartbeat_time = 100;
  Network network{{alive}, {}};
  network.slave(5, false).switch_on();  // without a heartbeat
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(10s), (Lines{"605 40 00 10 00 00 00 00 00", "585 43 00 10 00 91 01 0F 00", "(5 E)"}));
  EXPECT_FALSE(network.master.network_started());
}

TEST(NmtMaster, TheStateOfASlaveToBeKeptAliveIsInquiredWhereTheListHasNoTimes) {
  Network network{{NmtSlave{NodeId{5}, plain | assignment::keep_alive}}, {}};
  network.with_error_control = true;
  Slave& device = network.slave(5, false);
  device.switch_on();
  network.bus.attach().send(bench::frame("000 01 05"));
  network.pass(10ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(10s), (Lines{"(network started)", "605 40 00 10 00 00 00 00 00", "585 43 00 10 00 91 01 0F 00",
                                      "705 R 1", "705 05", "(5 state 05)", "(5 L)"}));
  EXPECT_EQ(device.state(), NmtState::operational);
}

TEST(NmtMaster, ASlaveToBeKeptAliveThatDoesNotAnswerGuardingIsNotReset) {
  Network network{{NmtSlave{NodeId{5}, plain | assignment::keep_alive}}, {}};
  network.with_error_control = true;
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(0ms), (Lines{"(network started)", "605 40 00 10 00 00 00 00 00"}));
  network.bus.attach().send(bench::frame("585 43 00 10 00 91 01 0F 00"));
  EXPECT_EQ(network.pass(10s),
            (Lines{"585 43 00 10 00 91 01 0F 00", "705 R 1", "705 R 1", "705 R 1", "(5 lost 00)", "(5 F)"}));
}

// A lost slave

TEST(NmtMaster, ResetsALostSlaveAndBootsItAgain) {
  NmtSlave slave{NodeId{5}, mandatory};
  slave.heartbeat_time = 100;
  Network network{{slave}, {}};
  Slave& device = network.slave(5, true);
  device.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(350ms);
  device.switch_off();
  EXPECT_EQ(network.pass(99ms), Lines{});
  EXPECT_EQ(network.pass(1ms), (Lines{"(5 lost 05)", "000 81 05"}));
  EXPECT_EQ(network.master.state(NodeId{5}), std::nullopt);
  device.switch_on();
  EXPECT_EQ(network.pass(10ms),
            (Lines{"705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00", "(5 back 7F)",
                   "585 43 00 10 00 91 01 0F 00", "605 40 17 10 00 00 00 00 00", "585 4B 17 10 00 32 00 00 00"}));
  EXPECT_EQ(network.pass(245ms), (Lines{"(5 0)", "000 01 05"}));
}

TEST(NmtMaster, StopsAllNodesWhenAMandatorySlaveIsLost) {
  Network network{{NmtSlave{NodeId{5}, mandatory | guarded}, NmtSlave{NodeId{6}, plain | guarded}},
                  {start_up::stop_all, 0ms}};
  Slave& fifth = network.slave(5, false);
  Slave& sixth = network.slave(6, false);
  fifth.switch_on();
  sixth.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(150ms);
  fifth.switch_off();
  EXPECT_EQ(network.pass(500ms), (Lines{"(5 lost 05)", "000 02 00", "(6 state 04)"}));
  EXPECT_EQ(sixth.state(), NmtState::stopped);
}

TEST(NmtMaster, ResetsAllNodesWhenAMandatorySlaveIsLost) {
  Network network{{NmtSlave{NodeId{5}, mandatory | guarded}, NmtSlave{NodeId{6}, plain | guarded}},
                  {start_up::reset_all, 0ms}};
  Slave& fifth = network.slave(5, false);
  network.slave(6, false).switch_on();
  fifth.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(150ms);
  fifth.switch_off();
  const Lines lines = network.pass(500ms);
  ASSERT_GE(lines.size(), 4u);
  EXPECT_EQ(Lines(lines.begin(), lines.begin() + 4), (Lines{"(5 lost 05)", "000 81 00", "706 00", "(6 boot-up 00)"}));
  EXPECT_EQ(lines.back(), "(6 state 05)");
}

TEST(NmtMaster, ResetsAnOptionalSlaveAlone) {
  Network network{{NmtSlave{NodeId{6}, plain | guarded}}, {start_up::stop_all | start_up::reset_all, 0ms}};
  Slave& sixth = network.slave(6, false);
  sixth.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(150ms);
  sixth.switch_off();
  EXPECT_EQ(network.pass(400ms), (Lines{"(6 lost 05)", "000 81 06"}));
}

}  // namespace
