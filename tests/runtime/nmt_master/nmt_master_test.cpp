#include <gtest/gtest.h>
#include <canopen/host/virtual_bus.hpp>
#include <canopen/nmt_master/nmt_master.hpp>

#include <array>
#include <list>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::BootStatus;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtMasterEvent;
using canopen::NmtSlave;
using canopen::NmtStartUp;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using canopen::VirtualBus;
namespace od = sample::od;
namespace assignment = canopen::slave_assignment;
namespace start_up = canopen::nmt_start_up;
using namespace std::chrono_literals;

constexpr const char* event_names[] = {"boot-up", "state", "unexpected state", "toggle error", "lost", "back"};

/// Records the events of the master.
struct Host {
  std::vector<std::string>* log;

  void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
    if (event == NmtMasterEvent::not_watched) return;  // true of most slaves here
    char text[40];
    std::snprintf(text, sizeof text, "(%d %s %02X)", node_id.value(), event_names[static_cast<int>(event)],
                  static_cast<unsigned>(state));
    log->push_back(text);
  }
  void booted(NodeId node_id, BootStatus status) {
    log->push_back("(" + std::to_string(node_id.value()) + " " + static_cast<char>(status) + ")");
  }
  void network_started() { log->push_back("(network started)"); }
  void boot_time_elapsed() { log->push_back("(boot time elapsed)"); }
};

/// The sample device as a slave on the bus: with a heartbeat every 50 ms after each reset, or guarded.
class Slave {
 public:
  Slave(VirtualBus& bus, std::uint8_t node_id, bool beats)
      : bus_{bus}, end_{bus.attach()}, node_{end_, NodeId{node_id}}, node_id_{node_id}, beats_{beats} {
    end_.on_frame = [this](const Frame& frame, TimePoint now) { on_frame(frame, now); };
    end_.on_time = [this](TimePoint now) {
      if (on_) node_.on_time(now);
    };
    end_.next_deadline = [this]() -> std::optional<TimePoint> { return on_ ? node_.next_deadline() : std::nullopt; };
  }

  void switch_on() {
    on_ = true;
    node_.start(bus_.now());
    after_reset();
  }
  void switch_off() { on_ = false; }

  [[nodiscard]] NmtState state() const { return node_.state(); }

 private:
  void on_frame(const Frame& frame, TimePoint now) {
    if (!on_) return;
    if (canopen::is_guarding_request(frame, node_id_) && !beats_) {
      guarding_.on_request(0, 0, now);
      EXPECT_TRUE(guarding_.serve(end_, node_id_, node_.state()));
      return;
    }
    node_.on_frame(frame, now);
    const auto command = canopen::nmt_command(frame, node_id_);
    if (command == NmtCommand::reset_node || command == NmtCommand::reset_communication) after_reset();
  }

  void after_reset() {
    guarding_.reset();
    if (beats_) {
      EXPECT_EQ(node_.set<od::producer_heartbeat_time>(50), canopen::ok);
    }
  }

  VirtualBus& bus_;
  VirtualBus::Endpoint& end_;
  canopen::Node<sample::Device, VirtualBus::Endpoint> node_;
  canopen::NodeGuardingSlave guarding_{};
  NodeId node_id_;
  bool beats_;
  bool on_ = false;
};

/// A master, its slaves, and everything that happens, in order: frames as in a candump log, events of the master in
/// brackets. PDOs are left out; so are heartbeats and guarding unless they are requested.
struct Network {
  Network(std::vector<NmtSlave> list, NmtStartUp how)
      : slaves{std::move(list)}, master{end, slaves, how, 100ms, Host{&log}} {
    VirtualBus::connect(end, master);
    bus.listen([this](const Frame& frame, TimePoint) {
      const std::uint32_t function = frame.id & ~0x7Fu;
      const bool boot_up = function == 0x700 && !frame.remote && frame.data[0] == 0;
      if (function >= 0x180 && function < 0x580) return;
      if (function == 0x700 && !boot_up && !with_error_control) return;
      log.push_back(bench::text(frame));
    });
  }

  Slave& slave(std::uint8_t node_id, bool beats) { return devices.emplace_back(bus, node_id, beats); }

  /// Returns what happens during this time.
  std::vector<std::string> pass(canopen::Duration span) {
    bus.run_for(span);
    return std::exchange(log, {});
  }

  VirtualBus bus;
  std::vector<std::string> log;
  bool with_error_control = false;
  std::vector<NmtSlave> slaves;
  VirtualBus::Endpoint& end = bus.attach();
  canopen::NmtMaster<VirtualBus::Endpoint, 8, Host> master;
  std::list<Slave> devices;
};

using Lines = std::vector<std::string>;

constexpr std::uint32_t guarded = (100u << 16) | (3u << 8);  ///< every 100 ms, lost after 300 ms

/// The identity of the sample device.
NmtSlave slave_with_identity(std::uint8_t node_id, std::uint32_t bits) {
  NmtSlave slave{NodeId{node_id}, bits};
  slave.device_type = 0xF0191;
  slave.vendor_id = 0x1234;
  slave.product_code = 0x10001;
  slave.revision_number = 0x10002;
  return slave;
}

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
    EXPECT_TRUE(master.command(command, NodeId{0}));
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
  EXPECT_EQ(network.pass(0ms), (Lines{
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
  EXPECT_EQ(network.pass(0ms),
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
  EXPECT_EQ(network.pass(500ms),
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
  EXPECT_EQ(network.pass(1s), (Lines{"705 00", "(5 boot-up 00)"})) << "nor booted again by itself";
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
  EXPECT_EQ(network.pass(1s), (Lines{"705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
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
                   "585 43 00 10 00 91 01 0F 00", "(5 0)", "706 00", "(6 boot-up 00)", "606 40 00 10 00 00 00 00 00",
                   "586 43 00 10 00 91 01 0F 00", "(6 0)", "(network started)", "000 01 00"}));
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

// Error control

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
                   "585 4B 17 10 00 32 00 00 00", "(5 0)", "000 01 05"}));
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
                   "605 2B 17 10 00 32 00 00 00", "585 60 17 10 00 00 00 00 00", "(5 state 7F)", "(5 0)",
                   "(network started)", "000 01 05", "(5 state 05)"}));
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
  EXPECT_EQ(network.pass(0ms),
            (Lines{"(network started)", "605 40 00 10 00 00 00 00 00", "585 43 00 10 00 91 01 0F 00", "(5 state 7F)",
                   "000 82 05", "705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00",
                   "585 43 00 10 00 91 01 0F 00", "(5 state 7F)", "(5 0)", "000 01 05"}));
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
  network.pass(50ms);
  device.switch_off();
  EXPECT_EQ(network.pass(99ms), Lines{});
  EXPECT_EQ(network.pass(1ms), (Lines{"(5 lost 05)", "000 81 05"}));
  EXPECT_EQ(network.master.state(NodeId{5}), std::nullopt);
  device.switch_on();
  EXPECT_EQ(network.pass(10ms), (Lines{"705 00", "(5 boot-up 00)", "605 40 00 10 00 00 00 00 00", "(5 back 7F)",
                                       "585 43 00 10 00 91 01 0F 00", "605 40 17 10 00 00 00 00 00",
                                       "585 4B 17 10 00 32 00 00 00", "(5 0)", "000 01 05"}));
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
                      "000 82 00",                                                 //
                      "(2 boot-up 00)", "(2 state 7F)", "(2 0)",     "000 01 02",  //
                      "(3 boot-up 00)", "(3 state 7F)", "(3 0)",     "000 01 03",  //
                      "(4 boot-up 00)", "(4 M)",                                   //
                      "(3 state 05)",   "(2 state 05)",                            //
                      "(6 B)",          "(5 B)",                                   //
                      "(6 boot-up 00)", "(6 state 7F)", "(6 0)",     "(network started)",
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
  EXPECT_EQ(letters, "0ABCDFJKLMNO");
  EXPECT_EQ(to_text(static_cast<BootStatus>('Z')), "unknown boot status");
}

}  // namespace
