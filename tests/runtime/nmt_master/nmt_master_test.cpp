/// The NMT master: commands, the boot-up of slaves, and NMT start-up.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <array>
#include <string>
#include <vector>

#include "nmt_master_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::BootStatus;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtSlave;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
using master_bench::Host;
using master_bench::Network;
using master_bench::Slave;
using master_bench::slave_with_identity;
namespace assignment = canopen::slave_assignment;
namespace start_up = canopen::nmt_start_up;
using namespace std::chrono_literals;

using Lines = std::vector<std::string>;

constexpr std::uint32_t guarded = (100u << 16) | (3u << 8);  ///< every 100 ms, lost after 300 ms

constexpr std::uint32_t plain = assignment::listed | assignment::boot;
constexpr std::uint32_t mandatory = plain | assignment::mandatory;

// Commands

TEST(NmtMaster, SendsEachCommandToOneNodeOrToAll) {
  bench::RecordingBus bus;
  Lines log;
  canopen::NmtMaster<bench::RecordingBus, 1, Host> master{bus, {}, {}, 100ms, Host{&log}};
  for (const NmtCommand command : {NmtCommand::start, NmtCommand::stop, NmtCommand::enter_pre_operational,
                                   NmtCommand::reset_node, NmtCommand::reset_communication}) {
    EXPECT_TRUE(master.command(command, NodeId{5}));
    EXPECT_TRUE(master.command(command, canopen::all_nodes));
  }
  EXPECT_EQ(bus.take(),
            "000 01 05 | 000 01 00 | 000 02 05 | 000 02 00 | 000 80 05 | 000 80 00 | 000 81 05 | 000 81 00 | "
            "000 82 05 | 000 82 00");
  bus.room = 0;
  EXPECT_FALSE(master.command(NmtCommand::start, NodeId{5}));
}

TEST(NmtMaster, KnowsWhoHasBootedListedOrNot) {
  bench::RecordingBus bus;
  Lines log;
  canopen::NmtMaster<bench::RecordingBus, 1, Host> master{bus, {}, {}, 100ms, Host{&log}};
  EXPECT_FALSE(master.has_booted(NodeId{127}));
  master.on_frame(bench::frame("77F 00"), TimePoint{});
  master.on_frame(bench::frame("720 7F"), TimePoint{});
  EXPECT_TRUE(master.has_booted(NodeId{127}));
  EXPECT_FALSE(master.has_booted(NodeId{0x20})) << "a heartbeat is not a boot-up message";
  EXPECT_EQ(log, (Lines{"(127 boot-up 00)", "(127 A)"}));
}

// Boot-up of one slave

TEST(NmtMaster, ResetsIdentifiesAndStartsASlave) {
  Network network{{slave_with_identity(5, mandatory)}, {start_up::master, 0ms}};
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(20ms), (Lines{
                                    "000 82 00",
                                    "705 00",
                                    "(5 boot-up 00)",
                                    "605 40 00 10 00 00 00 00 00",
                                    "585 43 00 10 00 91 01 0F 00",
                                    "605 40 18 10 01 00 00 00 00",
                                    "585 43 18 10 01 34 12 00 00",
                                    "605 40 18 10 02 00 00 00 00",
                                    "585 43 18 10 02 01 00 01 00",
                                    "605 40 18 10 03 00 00 00 00",
                                    "585 43 18 10 03 02 00 01 00",
                                    "(5 0)",
                                    "(network started)",
                                    "000 01 05",
                                }));
  EXPECT_EQ(network.devices.front().state(), NmtState::operational);
  EXPECT_EQ(network.master.status(NodeId{5}), BootStatus::booted);
  EXPECT_TRUE(network.master.network_started());
  EXPECT_EQ(network.pass(10s), Lines{});
}

TEST(NmtMaster, TellsWhichNumberOfTheIdentityIsWrong) {
  struct Row {
    std::uint32_t NmtSlave::*number;
    const char* status;
    BootStatus expected;
  };
  constexpr Row rows[] = {
      {&NmtSlave::device_type, "(5 C)", BootStatus::device_type},
      {&NmtSlave::vendor_id, "(5 D)", BootStatus::vendor_id},
      {&NmtSlave::product_code, "(5 M)", BootStatus::product_code},
      {&NmtSlave::revision_number, "(5 N)", BootStatus::revision_number},
      {&NmtSlave::serial_number, "(5 O)", BootStatus::serial_number},
  };
  for (const Row& row : rows) {
    NmtSlave slave = slave_with_identity(5, mandatory);
    slave.*row.number = 0xBAD;
    Network network{{slave}, {}};
    Slave& device = network.slave(5, false);
    device.switch_on();
    network.pass(0ms);
    network.master.start(network.bus.now());
    EXPECT_EQ(network.pass(10s).back(), row.status);
    EXPECT_EQ(network.master.status(NodeId{5}), row.expected);
    EXPECT_EQ(device.state(), NmtState::pre_operational) << "it is not started";
    EXPECT_FALSE(network.master.network_started());
  }
}

TEST(NmtMaster, ReadsOnlyTheDeviceTypeWhereNothingIsToBeCompared) {
  Network network{{NmtSlave{NodeId{5}, plain}}, {}};
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(20ms),
            (Lines{"(network started)", "000 82 00", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "(5 0)", "000 01 05"}))
      << "no slave is mandatory: the network has started before";
}

TEST(NmtMaster, AsksASilentSlaveEverySecond) {
  Network network{{NmtSlave{NodeId{5}, plain}}, {}};
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(999ms), (Lines{"(network started)", "000 82 00"}));
  EXPECT_EQ(network.pass(1ms), (Lines{"605 40 00 10 00 00 00 00 00"}));
  EXPECT_EQ(network.pass(100ms), (Lines{"(5 B)", "605 80 00 10 00 00 00 04 05"}));
  EXPECT_EQ(network.pass(999ms), Lines{});
  EXPECT_EQ(network.pass(1ms), (Lines{"000 80 05", "605 40 00 10 00 00 00 00 00"})) << "it may be in Stopped";
  EXPECT_EQ(network.pass(100ms), (Lines{"605 80 00 10 00 00 00 04 05"})) << "told once";
}

TEST(NmtMaster, FindsASlaveWhoseBootUpMessageItHasMissed) {
  Network network{{NmtSlave{NodeId{5}, plain}}, {}};
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(500ms);
  Slave& device = network.slave(5, false);
  network.end.on_frame = [](const Frame&, TimePoint) {};
  device.switch_on();
  network.pass(0ms);
  VirtualBus::connect(network.end, network.master);
  EXPECT_EQ(network.pass(520ms),
            (Lines{"605 40 00 10 00 00 00 00 00", "585 43 00 10 00 91 01 0F 00", "(5 0)", "000 01 05"}));
}

TEST(NmtMaster, ASlaveThatIsNotListedIsLeftAlone) {
  Network network{{NmtSlave{NodeId{5}, assignment::boot}}, {}};
  network.slave(5, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(10s), (Lines{"(network started)", "000 82 00", "705 00", "(5 boot-up 00)", "(5 A)"}));
}

TEST(NmtMaster, ASlaveWithoutTheBootBitIsNotStarted) {
  Network network{{NmtSlave{NodeId{5}, assignment::listed}}, {}};
  Slave& device = network.slave(5, false);
  device.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(1s).back(), "(5 0)");
  EXPECT_EQ(device.state(), NmtState::pre_operational);
  device.switch_on();
  EXPECT_EQ(network.pass(1s), (Lines{"705 00", "(5 boot-up 00)", "(5 restarted 00)"})) << "nor booted again by itself";
  network.master.boot(NodeId{5}, network.bus.now());
  EXPECT_EQ(network.pass(1s), (Lines{"000 82 05", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                                     "585 43 00 10 00 91 01 0F 00", "(5 0)"}));
}

TEST(NmtMaster, ASlaveThatBootsAgainIsBootedAgain) {
  Network network{{NmtSlave{NodeId{5}, plain}}, {}};
  Slave& device = network.slave(5, false);
  device.switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(1s);
  device.switch_on();
  EXPECT_EQ(network.pass(1s), (Lines{"705 00", "(5 boot-up 00)", "(5 restarted 00)", "605 40 00 10 00 00 00 00 00",
                                     "585 43 00 10 00 91 01 0F 00", "(5 0)", "000 01 05"}));
}

TEST(NmtMaster, ABootUpInTheMiddleOfTheIdentityBeginsAnew) {
  bench::RecordingBus bus;
  Lines log;
  const std::array slaves{slave_with_identity(5, plain)};
  canopen::NmtMaster<bench::RecordingBus, 1, Host> master{bus, slaves, {}, 100ms, Host{&log}};
  master.start(TimePoint{});
  master.on_frame(bench::frame("705 00"), TimePoint{});
  master.on_frame(bench::frame("585 43 00 10 00 91 01 0F 00"), TimePoint{});
  EXPECT_EQ(bus.take(), "000 82 00 | 605 40 00 10 00 00 00 00 00 | 605 40 18 10 01 00 00 00 00");
  master.on_frame(bench::frame("705 00"), TimePoint{});
  EXPECT_EQ(bus.take(), "605 80 18 10 01 22 00 00 08 | 605 40 00 10 00 00 00 00 00");
}

TEST(NmtMaster, KeepsCommandsUntilTheBusHasRoom) {
  bench::RecordingBus bus;
  Lines log;
  const std::array slaves{NmtSlave{NodeId{5}, plain}};
  canopen::NmtMaster<bench::RecordingBus, 1, Host> master{bus, slaves, {}, 100ms, Host{&log}};
  bus.room = 0;
  master.start(TimePoint{});
  EXPECT_EQ(master.next_deadline(), TimePoint{});
  bus.room = 10;
  master.on_time(TimePoint{1ms});
  EXPECT_EQ(bus.take(), "000 82 00");
  EXPECT_EQ(master.next_deadline(), TimePoint{1s});
}

// NMT start-up 1F80h

TEST(NmtMaster, StartsAllSlavesWithOneCommand) {
  Network network{{NmtSlave{NodeId{5}, mandatory}, NmtSlave{NodeId{6}, mandatory}}, {start_up::start_all, 0ms}};
  network.slave(5, false).switch_on();
  network.slave(6, false).switch_on();
  network.pass(0ms);
  network.master.start(network.bus.now());
  EXPECT_EQ(network.pass(1s),
            (Lines{"000 82 00", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "706 00", "(6 boot-up 00)", "606 40 00 10 00 00 00 00 00",
                   "586 43 00 10 00 91 01 0F 00", "(5 0)", "(6 0)", "(network started)", "000 01 00"}));
}

TEST(NmtMaster, LeavesTheStartToTheApplication) {
  for (const std::uint32_t bits : {start_up::no_slave_start, start_up::no_slave_start | start_up::start_all}) {
    Network network{{NmtSlave{NodeId{5}, mandatory}}, {bits, 0ms}};
    Slave& device = network.slave(5, false);
    device.switch_on();
    network.pass(0ms);
    network.master.start(network.bus.now());
    EXPECT_EQ(network.pass(10s).back(), "(network started)");
    EXPECT_EQ(device.state(), NmtState::pre_operational);
  }
}

TEST(NmtMaster, TellsWhenTheBootTimeHasElapsed) {
  Network network{{NmtSlave{NodeId{5}, mandatory}}, {0, 500ms}};
  network.pass(0ms);
  network.master.start(network.bus.now());
  network.pass(0ms);
  EXPECT_EQ(network.pass(499ms), Lines{});
  EXPECT_EQ(network.pass(1ms), (Lines{"(boot time elapsed)"}));
  network.slave(5, false).switch_on();
  EXPECT_EQ(network.pass(400ms), (Lines{"705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                                        "585 43 00 10 00 91 01 0F 00", "(5 0)", "(network started)", "000 01 05"}))
      << "it is still waited for";
}

// Five slaves: one of another type, one missing, one late

TEST(NmtMaster, BootsANetworkOfFive) {
  NmtSlave beating = slave_with_identity(3, mandatory);
  beating.heartbeat_time = 100;
  NmtSlave wrong = slave_with_identity(4, plain);
  wrong.product_code = 0x20001;
  Network network{{slave_with_identity(2, mandatory | guarded), beating, wrong, slave_with_identity(5, plain),
                   slave_with_identity(6, mandatory | guarded)},
                  {start_up::master, 5s}};
  network.slave(2, false).switch_on();
  network.slave(3, true).switch_on();
  Slave& fourth = network.slave(4, false);
  fourth.switch_on();
  Slave& late = network.slave(6, false);
  network.pass(0ms);
  network.master.start(network.bus.now());

  Lines told;
  const auto keep_told = [&told](const Lines& lines) {
    for (const std::string& line : lines) {
      if (line[0] == '(' || line.starts_with("000")) told.push_back(line);
    }
  };
  keep_told(network.pass(1500ms));
  late.switch_on();
  keep_told(network.pass(1s));
  EXPECT_EQ(told, (Lines{
                      "000 82 00",                                       //
                      "(2 boot-up 00)", "(2 state 7F)",                  //
                      "(3 boot-up 00)", "(3 state 7F)",                  //
                      "(4 boot-up 00)", "(4 M)",                         //
                      "(2 0)",          "000 01 02",    "(2 state 05)",  //
                      "(3 0)",          "000 01 03",    "(3 state 05)",  //
                      "(6 B)",          "(5 B)",                         //
                      "(6 boot-up 00)", "(6 state 7F)", "(6 0)",        "(network started)",
                      "000 01 06",      "(6 state 05)", "000 80 05",
                  }));
  EXPECT_EQ(fourth.state(), NmtState::pre_operational);
  EXPECT_EQ(late.state(), NmtState::operational);
  EXPECT_EQ(network.master.status(NodeId{4}), BootStatus::product_code);
  EXPECT_EQ(network.master.status(NodeId{5}), BootStatus::no_response);
  EXPECT_EQ(network.master.status(NodeId{6}), BootStatus::booted);
  for (const std::uint8_t node_id : {std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}, std::uint8_t{6}}) {
    EXPECT_TRUE(network.master.has_booted(NodeId{node_id}));
  }
  EXPECT_FALSE(network.master.has_booted(NodeId{5}));
}

TEST(BootStatus, HasALetterAndATextForEach) {
  std::string letters;
  for (const canopen::BootStatusText& row : canopen::boot_status_texts) {
    letters += static_cast<char>(row.status);
    EXPECT_EQ(to_text(row.status), row.text);
  }
  EXPECT_EQ(letters, "0ABCDEFGHIJKLMNOrxwhs");
  EXPECT_EQ(to_text(static_cast<BootStatus>('Z')), "unknown boot status");
}

}  // namespace
