/// The supervised boot-up (CiA 302-2, and CiA 301 for what a slave may send): slaves with faults of hardware and
/// firmware are never started without their configuration, and the master reports the fault. The slaves do not use the
/// runtime.
#include <gtest/gtest.h>
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen_sim/bus_faults.hpp>
#include <canopen_sim/virtual_bus.hpp>

#include <chrono>
#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "supervised_boot_bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::BootResult;
using canopen::BootStatus;
using canopen::NmtMasterEvent;
using canopen::NmtState;
using namespace std::chrono_literals;
using namespace supervised;

struct Log {
  std::vector<BootResult> results;  ///< of node 5
  unsigned restarts = 0;            ///< of booted slaves
  bool network_started = false;

  [[nodiscard]] std::string letters() const {
    std::string text;
    for (const BootResult& result : results) text += static_cast<char>(result.status);
    return text;
  }
};

struct Host {
  Log* log;
  void happened(NmtMasterEvent event, NodeId, NmtState) {
    if (event == NmtMasterEvent::restarted) ++log->restarts;
  }
  void booted(NodeId node_id, const BootResult& result) {
    if (node_id == NodeId{5}) log->results.push_back(result);
  }
  void network_started() { log->network_started = true; }
  void boot_time_elapsed() {}
};

struct Network : SlaveBus {
  explicit Network(std::vector<NmtSlave> list, canopen::NmtStartUp start_up = {})
      : slaves{std::move(list)}, master{end, slaves, start_up, 100ms, Host{&log}} {
    VirtualBus::connect(end, master);
  }

  /// Lets time pass. `status` is always the one that the host got last.
  void run(std::chrono::milliseconds span) {
    for (; span > 0ms; span -= 1ms) {
      bus.run_for(1ms);
      if (!log.results.empty()) {
        ASSERT_EQ(master.status(NodeId{5}), log.results.back().status);
      }
    }
  }
  void start() { master.start(bus.now()); }

  Log log;
  std::vector<NmtSlave> slaves;
  VirtualBus::Endpoint& end = bus.attach();
  canopen::NmtMaster<VirtualBus::Endpoint, 4, Host> master;
};

class SupervisedBoot : public testing::TestWithParam<std::uint16_t> {};

TEST_P(SupervisedBoot, NeverStartsASlaveWithoutItsConfiguration) {
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    Network network{{listed(5, GetParam())}};
    faulty::Slave& slave = network.add({.values = {}, .fault = row.fault, .entry = row.entry, .times = row.times});
    network.run(10ms);
    network.start();
    network.run(20s);
    const std::string letters = network.log.letters();
    EXPECT_EQ(slave.wrong_starts(), 0u);
    EXPECT_EQ(slave.operational(), row.started);
    EXPECT_EQ(network.log.network_started, row.started);
    const bool is_after_start = GetParam() == 0 && row.fault == Fault::starts_twice;
    EXPECT_EQ(letters, is_after_start ? "00" : row.letters);
    EXPECT_EQ(network.log.restarts, is_after_start ? 1u : 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutHeartbeat, SupervisedBoot,
                         testing::Values(std::uint16_t{200}, std::uint16_t{0}));

TEST(SupervisedBoot, TellsTheValueThatWasNotWritten) {
  Network network{{listed(5, 0)}};
  network.add({.values = {}, .fault = Fault::ignores_write, .entry = 0x200200});
  network.start();
  network.run(5s);
  ASSERT_FALSE(network.log.results.empty());
  const BootResult& result = network.log.results.back();
  EXPECT_EQ(result.index, 0x2002);
  EXPECT_EQ(result.expected, 0x1234u);
  EXPECT_EQ(result.seen, 0u);
}

TEST(SupervisedBoot, TellsTheEntryOfALateAbort) {
  Network network{{listed(5, 0)}};
  network.add({.values = {}, .fault = Fault::late_abort, .entry = 0x200100});
  network.start();
  network.run(5s);
  ASSERT_FALSE(network.log.results.empty());
  EXPECT_EQ(network.log.results.back().index, 0x2001);
  EXPECT_EQ(network.log.results.back().abort_code, AbortCode::invalid_value);
}

TEST(SupervisedBoot, DoesNotReadBackIfTheListSaysSo) {
  NmtSlave without = listed(5, 0);
  without.read_back = false;
  Network network{{without}};
  faulty::Slave& slave = network.add({.values = {}, .fault = Fault::ignores_write, .entry = 0x200200});
  network.start();
  network.run(1s);
  EXPECT_TRUE(slave.operational());
}

// Two nodes with one node-ID

TEST(SupervisedBoot, TwoNodesWithOneNodeIdAreNotStarted) {
  struct Twin {
    const char* name;
    Fault fault;
    std::uint32_t delay_us, boot_us;
    std::uint8_t heartbeat;
  };
  constexpr Twin twins[] = {
      {"equal", Fault::none, 300, 2'000, 0},
      {"slower", Fault::none, 2'500, 2'000, 0},
      {"starts 1.2 ms later", Fault::none, 300, 3'200, 0},
      {"starts 500 ms later", Fault::none, 300, 500'000, 0},
      {"rejects a value", Fault::rejects_write, 700, 3'200, 0},
      {"rejects a value, with heartbeat", Fault::rejects_write, 700, 3'200, 200},
      {"equal, with heartbeat", Fault::none, 300, 2'000, 200},
  };
  for (const Twin& twin : twins) {
    SCOPED_TRACE(twin.name);
    Network network{{listed(5, twin.heartbeat)}};
    faulty::Slave& one = network.add({});
    faulty::Slave& other = network.add(
        {.values = {}, .fault = twin.fault, .entry = 0x180001, .delay_us = twin.delay_us, .boot_us = twin.boot_us});
    network.start();
    network.run(20s);
    EXPECT_EQ(one.wrong_starts() + other.wrong_starts(), 0u);
    EXPECT_FALSE(one.operational());
    EXPECT_FALSE(other.operational());
    ASSERT_FALSE(network.log.results.empty());
    const BootStatus last = network.log.results.back().status;
    EXPECT_TRUE(last == BootStatus::extra_response || last == BootStatus::restarted) << static_cast<char>(last);
    EXPECT_EQ(network.log.network_started, twin.boot_us == 500'000) << "one of them is the only one for half a second";
  }
}

TEST(SupervisedBoot, ASecondNodeThatIsSwitchedOnLaterStopsBoth) {
  Network network{{listed(5, 200)}};
  faulty::Slave& one = network.add({});
  network.start();
  network.run(2s);
  EXPECT_TRUE(one.operational());
  faulty::Slave& other = network.add({});
  network.run(10s);
  EXPECT_FALSE(one.operational());
  EXPECT_FALSE(other.operational());
  EXPECT_EQ(network.log.restarts, 1u) << "the boot-up message of the second one";
  EXPECT_EQ(network.log.letters(), "0xx");
  other.power_off();
  network.master.boot(NodeId{5}, network.bus.now());
  network.run(2s);
  EXPECT_TRUE(one.operational()) << "it is booted when it is alone";
}

// Heartbeats

TEST(SupervisedBoot, MeasuresTheRateOfTheHeartbeats) {
  for (const std::uint16_t consumer : std::initializer_list<std::uint16_t>{20, 100, 200, 1000, 2000}) {
    for (const auto& [fault, letters] :
         {std::pair{Fault::none, "0"}, std::pair{Fault::heartbeat_fast, "hhh"}, std::pair{Fault::heartbeat_slow, "hhh"},
          std::pair{Fault::heartbeat_states, "sss"}}) {
      SCOPED_TRACE(std::to_string(consumer) + " ms, fault " + std::to_string(static_cast<int>(fault)));
      Network network{{listed(5, consumer)}};
      faulty::Slave& slave = network.add({.values = {}, .fault = fault});
      network.start();
      network.run(30s);
      const bool is_good = fault == Fault::none;
      EXPECT_EQ(slave.operational(), is_good);
      if (fault == Fault::heartbeat_slow) {
        EXPECT_NE(network.log.letters().find_first_of("hK"), std::string::npos);
      } else {
        EXPECT_EQ(network.log.letters(), letters);
      }
    }
  }
}

TEST(SupervisedBoot, AMasterThatReadsOneHeartbeatLateStartsTheSlave) {
  Network network{{listed(5, 200)}};
  faulty::Slave& slave = network.add({.values = {}});
  std::optional<canopen::Frame> late;
  network.end.on_frame = [&,
                          read = std::function<void(const canopen::Frame&, canopen::TimePoint)>{network.end.on_frame},
                          is_first = true](const canopen::Frame& frame, canopen::TimePoint now) mutable {
    const bool is_heartbeat = frame.id == 0x705 && frame.data[0] == 0x7F;
    if (is_heartbeat && is_first) {
      late = frame;
      is_first = false;
    } else {
      read(frame, now);
    }
  };
  network.start();
  while (!late) network.run(1ms);
  network.run(90ms);
  network.master.on_frame(*late, network.bus.now());
  network.run(5s);
  EXPECT_TRUE(slave.operational());
  EXPECT_EQ(network.log.letters(), "0");
}

TEST(SupervisedBoot, TellsTheHeartbeatTime) {
  Network network{{listed(5, 200)}};
  network.add({.values = {}, .fault = Fault::heartbeat_fast});
  network.start();
  network.run(10s);
  const BootResult& result = network.log.results.back();
  EXPECT_EQ(result.status, BootStatus::heartbeat_rate);
  EXPECT_EQ(result.expected, 100u);
  EXPECT_NEAR(result.seen, 50, 1);
}

// Date and time of the configuration

TEST(SupervisedBoot, ASlaveThatHasTheDateButNotTheValuesIsConfigured) {
  NmtSlave dated = listed(5, 0);
  dated.configuration_date = 15'668;
  dated.configuration_time = 43'200'000;
  for (const bool has_values : {false, true}) {
    SCOPED_TRACE(has_values);
    Network network{{dated}};
    faulty::Values values = default_values();
    values[0x102001] = {0x34, 0x3D, 0x00, 0x00};
    values[0x102002] = {0x00, 0x2E, 0x93, 0x02};
    if (has_values) {
      for (const auto& [entry, bytes] : configured) values[entry] = bytes;
    }
    faulty::Slave& slave = network.add({.values = values});
    network.start();
    network.run(1s);
    EXPECT_TRUE(slave.operational());
    EXPECT_EQ(slave.wrong_starts(), 0u);
    EXPECT_EQ(network.master.configuration_is_current(NodeId{5}), has_values);
    EXPECT_EQ(network.log.letters(), "0");
  }
}

// The other slaves

TEST(SupervisedBoot, TheNetworkStartsWithoutAnOptionalSlaveAndNotWithoutAMandatoryOne) {
  for (const std::uint32_t bits : {std::uint32_t{0}, canopen::nmt_start_up::start_all}) {
    for (const bool mandatory : {false, true}) {
      SCOPED_TRACE(std::to_string(bits) + (mandatory ? " mandatory" : " optional"));
      Network network{{listed(5, 0, mandatory), listed(6, 0)}, {bits}};
      faulty::Slave& bad = network.add({.values = {}, .fault = Fault::ignores_write, .entry = 0x200100});
      faulty::Slave& good = network.add({.node_id = 6});
      network.start();
      network.run(10s);
      EXPECT_EQ(network.log.network_started, !mandatory);
      EXPECT_EQ(bad.starts(), 0u) << "not by a command to all nodes either";
      EXPECT_EQ(good.operational(), !mandatory || bits == 0);
      EXPECT_EQ(good.wrong_starts(), 0u);
    }
  }
}

// Slow slaves

TEST(SupervisedBoot, ASlowSlaveBootsWithItsOwnTimeout) {
  for (const std::uint16_t timeout : std::initializer_list<std::uint16_t>{0, 300}) {
    NmtSlave slow = listed(5, 0);
    slow.sdo_timeout = timeout;
    Network network{{slow, listed(6, 0)}};
    faulty::Slave& slave = network.add({.delay_us = 170'000});
    faulty::Slave& other = network.add({.node_id = 6});
    network.start();
    network.run(20s);
    EXPECT_EQ(slave.operational(), timeout != 0) << "the time-out of the master is 100 ms";
    EXPECT_TRUE(other.operational());
    EXPECT_EQ(slave.wrong_starts(), 0u);
    const std::string letters = network.log.letters();
    EXPECT_EQ(letters, timeout == 0 ? "B" : "0") << "late responses are not those of a second node";
  }
}

TEST(SupervisedBoot, ALateResponseIsNotThatOfASecondNode) {
  for (std::uint32_t delay = 10'000; delay < 400'000; delay += 13'000) {
    SCOPED_TRACE(delay);
    Network network{{listed(5, 0)}};
    network.add({.delay_us = delay});
    network.start();
    network.run(20s);
    EXPECT_EQ(network.log.letters().find('x'), std::string::npos) << network.log.letters();
  }
}

// Faults of the bus

TEST(SupervisedBoot, OnABusThatLosesAndDelaysFramesNothingIsStartedWithoutItsConfiguration) {
  constexpr canopen::BusFaultRates rates{.lost = 0.03, .repeated = 0.01, .delayed = 0.1, .longest_delay = 150ms};
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    Network network{{listed(5, seed % 2 == 0 ? 200 : 0), listed(6, 100)},
                    {seed % 3 == 0 ? canopen::nmt_start_up::start_all : 0u}};
    std::list<canopen::BusFaults> faults;
    const auto disturb = [&](VirtualBus::Endpoint& port) {
      faults.emplace_back(port, rates, seed * 10 + static_cast<std::uint32_t>(faults.size()));
    };
    std::vector<faulty::Slave*> slaves;
    constexpr Fault kinds[] = {Fault::none, Fault::loses_power, Fault::ignores_write, Fault::late_abort,
                               Fault::answers_twice};
    slaves.push_back(&network.add({.values = {}, .fault = kinds[seed % 5], .entry = 0x200200, .times = 1 + seed % 4}));
    slaves.push_back(
        &network.add({.node_id = 6, .values = {}, .fault = kinds[seed / 5 % 5], .entry = 0x200C00, .times = 1}));
    for (VirtualBus::Endpoint* const port : network.ports) disturb(*port);
    disturb(network.end);
    network.start();
    network.run(15s);
    for (canopen::BusFaults& one : faults) one.rates = {};
    for (faulty::Slave* const slave : slaves) slave->end_fault();
    network.run(3s);
    for (const std::uint8_t node_id : std::initializer_list<std::uint8_t>{5, 6}) {
      if (network.master.status(NodeId{node_id}) != BootStatus::booted)
        network.master.boot(NodeId{node_id}, network.bus.now());
    }
    network.run(5s);
    for (const faulty::Slave* const slave : slaves) {
      EXPECT_EQ(slave->wrong_starts(), 0u);
      EXPECT_TRUE(slave->operational());
    }
  }
}

}  // namespace
