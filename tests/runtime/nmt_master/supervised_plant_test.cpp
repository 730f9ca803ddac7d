/// The supervised boot-up in a plant: what the master of a network does with slaves that have faults, and what its
/// application and its log learn.
#include <gtest/gtest.h>
#include <canopen_plant/plant.hpp>
#include <canopen_plant/plant_text.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <sample/device.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "supervised_boot_bench.hpp"

namespace {

using canopen::PlantFault;
using canopen::PlantNode;
using namespace std::chrono_literals;
using namespace supervised;

/// As `edsc network generate` writes it: one node without signals.
struct PlantNetwork {
  using Master = sample::Device;
  static constexpr NodeId master_id{127};
  static constexpr canopen::NmtStartUp start_up{};
  static constexpr std::array<PlantNode, 1> nodes{{{"axis", NodeId{5}, 0x85}}};
  static constexpr std::array<NmtSlave, 1> slaves{{listed(5, 200)}};
  static constexpr std::array<canopen::PlantPlace, 2> places{
      {{NodeId{5}, 0, 0, "plant.json", 7}, {NodeId{5}, 0x2002, 0, "plant.json", 9}}};
  using Received = canopen::SignalList<>;
  using Sent = canopen::SignalList<>;
  template <class Plant>
  struct Nodes {
    explicit Nodes(Plant& plant) : axis{plant} {}
    canopen::PlantNodeAccess<Plant, 0> axis;
  };
};

struct Network : SlaveBus {
  Network() {
    VirtualBus::connect(end, plant);
    plant.on_fault = [this](const PlantNode& node, const PlantFault& fault) {
      faults.push_back(fault_text(node, fault, PlantNetwork::places));
    };
    plant.on_booted = [this](const PlantNode&) { ++booted; };
  }

  void start() {
    bus.run_for(10ms);
    plant.start(bus.now());
    bus.run_for(20s);
  }

  std::vector<std::string> faults;
  unsigned booted = 0;
  VirtualBus::Endpoint& end = bus.attach();
  canopen::Plant<PlantNetwork, VirtualBus::Endpoint> plant{end};
};

TEST(SupervisedPlant, NeverStartsANodeWithoutItsConfiguration) {
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    Network network;
    faulty::Slave& slave = network.add({.values = {}, .fault = row.fault, .entry = row.entry, .times = row.times});
    network.start();
    EXPECT_EQ(slave.wrong_starts(), 0u);
    EXPECT_EQ(slave.operational(), row.started);
    EXPECT_EQ(network.plant.axis.booted(), row.started);
    EXPECT_EQ(network.booted, row.started ? 1u : 0u);
    EXPECT_EQ(network.faults.size(), std::string{row.letters}.size() - (row.started ? 1u : 0u));
  }
}

TEST(SupervisedPlant, TellsTheFaultWithItsLine) {
  Network network;
  network.add({.values = {}, .fault = Fault::ignores_write, .entry = 0x200200});
  network.start();
  ASSERT_FALSE(network.faults.empty());
  EXPECT_EQ(network.faults.back(),
            "plant.json:9: axis: value read back is not the one written: 2002h:00: expected 00001234h, seen 00000000h");
}

TEST(SupervisedPlant, TwoNodesWithOneNodeIdAreNotStarted) {
  Network network;
  faulty::Slave& one = network.add({});
  faulty::Slave& other = network.add({.delay_us = 700, .boot_us = 3'200});
  network.start();
  EXPECT_EQ(one.starts() + other.starts(), 0u);
  ASSERT_EQ(network.faults.size(), 3u);
  EXPECT_NE(network.faults.back().find("two nodes have its node-ID"), std::string::npos) << network.faults.back();
}

TEST(SupervisedPlant, TellsThatARunningNodeHasRestarted) {
  Network network;
  faulty::Slave& slave = network.add({});
  network.start();
  slave.power_on(network.bus.elapsed());
  network.bus.run_for(5s);
  EXPECT_EQ(network.faults,
            std::vector<std::string>{"axis: restarted without a command, or a second node has its node-ID"});
  EXPECT_EQ(network.booted, 2u);
  EXPECT_TRUE(slave.operational());
}

}  // namespace
