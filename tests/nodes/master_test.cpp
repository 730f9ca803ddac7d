/// The master of the example and the plant on one bus, in a time of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/port/virtual_bus.hpp>
#include <canopen/port/virtual_bus_port.hpp>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "master/plant_master.hpp"
#include "plant/plant.hpp"
#include "unit/bench.hpp"

namespace {

using namespace std::chrono_literals;

struct MasterAndPlant : testing::Test {
  MasterAndPlant() {
    canopen::VirtualBus::connect(end, plant);
    end.queue_limit = 64;
    end.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) {
      if (!loses || !loses(frame)) plant.on_frame(frame, now);
    };
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) { frames.push_back(bench::text(frame)); });
    plant.start(bus.now());
    master.start();
  }
  void run(unsigned cycles) {
    for (unsigned i = 0; i < cycles; ++i) master.run_cycle();
  }
  [[nodiscard]] bool logged(std::string_view line) const { return std::ranges::find(log, line) != log.end(); }
  [[nodiscard]] bool sent(std::string_view frame) const { return std::ranges::find(frames, frame) != frames.end(); }

  std::vector<std::string> log;
  std::vector<std::string> frames;
  std::function<bool(const canopen::Frame&)> loses;  ///< frames that do not reach the plant
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& end = bus.attach();
  nodes::Surroundings around;
  Plant<canopen::VirtualBus::Endpoint> plant{end, around};
  canopen::VirtualBusPort port{bus};
  PlantMaster<canopen::VirtualBusPort> master{port, [this](std::string_view line) { log.emplace_back(line); }};
};

TEST_F(MasterAndPlant, BootConfigureAndStart) {
  run(10);
  EXPECT_TRUE(master.running());
  for (const char* const line :
       {"node 1: booted", "node 2: booted", "node 3: booted", "node 4: booted", "all nodes are configured: started"}) {
    EXPECT_TRUE(logged(line)) << line;
  }
  EXPECT_TRUE(sent("000 82 00"));
  EXPECT_TRUE(sent("601 40 00 10 00 00 00 00 00"));
  EXPECT_TRUE(sent("581 43 00 10 00 91 01 02 00"));
  EXPECT_TRUE(sent("601 2B 0C 10 00 64 00 00 00"));
  EXPECT_TRUE(sent("604 2B 01 18 05 32 00 00 00"));
  EXPECT_TRUE(sent("000 01 00"));
}

TEST_F(MasterAndPlant, ExchangeProcessData) {
  run(40);
  EXPECT_GT(master.agreed(), 20u);
  EXPECT_EQ(master.differed(), 0u);
  EXPECT_TRUE(sent("201 01 00"));
  EXPECT_TRUE(sent("182 01 00"));
  EXPECT_TRUE(sent("303 E8 03 00 00 00 00 00 00"));
  EXPECT_TRUE(sent("284 E8 03 00 00 00 00 00 00"));
}

TEST_F(MasterAndPlant, StopTheOutputsWhileANodeIsLostAndGoOnWithIt) {
  run(20);
  ASSERT_TRUE(master.running());
  const auto of_node_4 = [](const canopen::Frame& frame) {
    return frame.id == 0x704 || frame.id == 0x604 || (frame.id == 0 && frame.data[1] == 4);
  };
  loses = of_node_4;
  run(6);
  EXPECT_TRUE(logged("node 4 is lost: outputs stop"));
  EXPECT_FALSE(master.running());
  EXPECT_TRUE(sent("000 02 01"));
  EXPECT_TRUE(sent("000 02 03"));
  EXPECT_EQ(plant.digital_out().node().state(), canopen::NmtState::stopped);
  EXPECT_EQ(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>(), 0);
  EXPECT_EQ(plant.analogue_out().node().get<can_2024c::od::write_analogue_output_16_bit<1>>(), 0);
  loses = nullptr;
  log.clear();
  run(40);
  EXPECT_TRUE(logged("node 4: booted"));
  EXPECT_TRUE(logged("all nodes are configured: started"));
  EXPECT_TRUE(master.running());
  const unsigned agreed = master.agreed();
  run(10);
  EXPECT_GT(master.agreed(), agreed);
}

TEST_F(MasterAndPlant, GoOnWhenAllNodesAreLostAndBack) {
  run(20);
  end.on_frame = nullptr;
  run(20);
  EXPECT_TRUE(logged("node 1 is lost: outputs stop"));
  EXPECT_TRUE(logged("node 4 is lost: outputs stop"));
  log.clear();
  end.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) { plant.on_frame(frame, now); };
  run(100);
  EXPECT_TRUE(logged("all nodes are configured: started"));
  EXPECT_TRUE(master.running());
}

TEST_F(MasterAndPlant, BringTheOutputsToTheirErrorValuesWhenTheMasterIsLost) {
  run(20);
  EXPECT_NE(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>(), 0);
  bus.run_for(1s);  // nobody guards
  EXPECT_EQ(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>(), 0);
  EXPECT_EQ(plant.analogue_out().node().get<can_2024c::od::write_analogue_output_16_bit<1>>(), 0);
  EXPECT_TRUE(sent("081 30 81 11 07 00 00 00 00"));
}

TEST_F(MasterAndPlant, ReportEmergencies) {
  run(10);
  plant.input(nodes::InputLine{"node 2 fault eeprom"}, bus.now());
  run(1);
  EXPECT_TRUE(logged("node 2 tells EMCY 5000h"));
}

// canopen::Master on its own

struct MasterOfOne : testing::Test {
  MasterOfOne() {
    canopen::VirtualBus::connect(end, module);
    module.start(bus.now());
    bus.settle();
  }
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& end = bus.attach();
  nodes::Surroundings around{canopen::NodeId{5}};
  Can2053c<canopen::VirtualBus::Endpoint> module{end, around};
  canopen::VirtualBusPort port{bus};
  canopen::Master<canopen::VirtualBusPort> master{port};
  canopen::MasterRemote<can_2053c::Device, canopen::VirtualBusPort> inputs =
      master.remote<can_2053c::Device>(canopen::NodeId{5});
};

TEST_F(MasterOfOne, ReadsAndWritesObjects) {
  namespace od = can_2053c::od;
  EXPECT_TRUE(inputs.write<od::guard_time>(250));
  EXPECT_EQ(inputs.read<od::guard_time>().value(), 250);
  EXPECT_EQ(inputs.read<od::device_type>().value(), 0x0001'0191u);
}

TEST_F(MasterOfOne, TakesPdosAndAsksForThem) {
  std::vector<int> got;
  EXPECT_TRUE(inputs.on_pdo<can_2053c::Tpdo1>([&](auto low, auto high) { got = {low, high}; }));
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, canopen::NodeId{5}));
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0}));
  module.set_digital(1, 0x80);
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80}));
  got.clear();
  EXPECT_TRUE(inputs.request<can_2053c::Tpdo1>());
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80}));
}

TEST_F(MasterOfOne, KeepsPdosThatComeDuringATransferAndLetsHandlersTransfer) {
  namespace od = can_2053c::od;
  std::vector<unsigned> read;
  EXPECT_TRUE(inputs.on_pdo<can_2053c::Tpdo1>(
      [&](auto, auto) { read.push_back(inputs.read<od::read_input_8_bit<1>>().value()); }));
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, canopen::NodeId{5}));
  EXPECT_TRUE(inputs.write<od::guard_time>(100));  // the TPDO of the start comes meanwhile
  EXPECT_TRUE(read.empty());
  module.set_digital(0, 7);
  master.poll(10ms);
  EXPECT_EQ(read.back(), 7u);
}

TEST_F(MasterOfOne, HasNoPdoThatIsNotValid) {
  namespace od = can_2053c::od;
  EXPECT_TRUE(inputs.write<od::tpdo_communication_parameter_1::cob_id_used_by_tpdo>(0x8000'0185u));
  const auto done = inputs.on_pdo<can_2053c::Tpdo1>([](auto, auto) {});
  EXPECT_EQ(done.abort_code(), canopen::AbortCode::device_state);
}

}  // namespace
