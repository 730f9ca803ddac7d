/// The master of the example and the plant on one bus, in simulated time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen_plant/plant_text.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "master/plant_master.hpp"
#include "plant/plant.hpp"
#include "support/bench.hpp"

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
  std::function<bool(const canopen::Frame&)> loses;  ///< frames that are lost before the plant
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
  EXPECT_EQ(canopen::to_raw(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>()), 0);
  EXPECT_EQ(canopen::to_raw(plant.analogue_out().node().get<can_2024c::od::write_analogue_output_16_bit<1>>()), 0);
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
  EXPECT_NE(canopen::to_raw(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>()), 0);
  bus.run_for(1s);  // no guarding
  EXPECT_EQ(canopen::to_raw(plant.digital_out().node().get<can_2057c::od::write_output_8_bit<1>>()), 0);
  EXPECT_EQ(canopen::to_raw(plant.analogue_out().node().get<can_2024c::od::write_analogue_output_16_bit<1>>()), 0);
  EXPECT_TRUE(sent("081 30 81 11 07 00 00 00 00"));
}

TEST_F(MasterAndPlant, ReportEmergencies) {
  run(10);
  plant.input(nodes::InputLine{"node 2 fault eeprom"}, bus.now());
  run(1);
  EXPECT_TRUE(logged("node 2 tells EMCY 5000h"));
}

// Only canopen::Master

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
  EXPECT_TRUE(inputs.write<od::guard_time>(canopen::raw(250)));
  EXPECT_EQ(canopen::to_raw(inputs.read<od::guard_time>().value()), 250);
  EXPECT_EQ(canopen::to_raw(inputs.read<od::device_type>().value()), 0x0001'0191u);
}

TEST_F(MasterOfOne, TakesPdosAndAsksForThem) {
  std::vector<int> got;
  EXPECT_TRUE(inputs.on_pdo<can_2053c::Tpdo1>([&](auto low, auto high) { got = {low.raw(), high.raw()}; }));
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
      [&](auto, auto) { read.push_back(inputs.read<od::read_input_8_bit<1>>().value().raw()); }));
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, canopen::NodeId{5}));
  EXPECT_TRUE(
      inputs.write<od::guard_time>(canopen::raw(100)));  // the TPDO that follows the start is received meanwhile
  EXPECT_TRUE(read.empty());
  module.set_digital(0, 7);
  master.poll(10ms);
  EXPECT_EQ(read.back(), 7u);
}

TEST_F(MasterOfOne, HasNoPdoThatIsNotValid) {
  namespace od = can_2053c::od;
  EXPECT_TRUE(inputs.write<od::tpdo_communication_parameter_1::cob_id_used_by_tpdo>(canopen::raw(0x8000'0185u)));
  const auto done = inputs.on_pdo<can_2053c::Tpdo1>([](auto, auto) {});
  EXPECT_EQ(done.abort_code(), canopen::AbortCode::device_state);
}

// COB-IDs that change

TEST_F(MasterOfOne, FollowsACobIdThatIsWrittenThroughIt) {
  namespace od = can_2053c::od;
  using CobId = od::tpdo_communication_parameter_1::cob_id_used_by_tpdo;
  std::vector<int> got;
  ASSERT_TRUE(inputs.on_pdo<can_2053c::Tpdo1>([&](auto low, auto high) { got = {low.raw(), high.raw()}; }));
  EXPECT_TRUE(inputs.write<CobId>(canopen::raw(0x8000'0185u)));
  EXPECT_TRUE(inputs.write<CobId>(canopen::raw(0x0000'01C5u)));
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, canopen::NodeId{5}));
  module.set_digital(1, 0x80);
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80}));
  got.clear();
  EXPECT_TRUE(inputs.request<can_2053c::Tpdo1>());
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80}));
}

TEST_F(MasterOfOne, ReadsTheCobIdsAgainWhenTheNodeHasBootedUp) {
  namespace od = can_2053c::od;
  using CobId = od::tpdo_communication_parameter_1::cob_id_used_by_tpdo;
  std::vector<int> got;
  EXPECT_TRUE(inputs.write<CobId>(canopen::raw(0x8000'0185u)));
  EXPECT_TRUE(inputs.write<CobId>(canopen::raw(0x0000'01C5u)));
  ASSERT_TRUE(inputs.on_pdo<can_2053c::Tpdo1>([&](auto low, auto high) { got = {low.raw(), high.raw()}; }));
  EXPECT_TRUE(master.command(canopen::NmtCommand::reset_communication, canopen::NodeId{5}));
  master.poll(10ms);
  EXPECT_TRUE(master.command(canopen::NmtCommand::start, canopen::NodeId{5}));
  module.set_digital(1, 0x80);
  master.poll(10ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80})) << "on 185h again";
}

// Boot-up with canopen::Master

using canopen::NodeId;

/// A CAN-2053C as node 5, and a master that boots it.
struct Boot : testing::Test {
  Boot() {
    canopen::VirtualBus::connect(end, module);
    module.start(bus.now());
    const canopen::NmtSlave slave{NodeId{5}, canopen::slave_assignment::listed | canopen::slave_assignment::boot |
                                                 canopen::slave_assignment::mandatory};
    master.emplace(port, std::vector{slave});
    inputs.emplace(*master, NodeId{5});
    master->on_booted = [this](NodeId node_id, const canopen::BootResult& result) {
      log.push_back(boot_text(node_id, result));
    };
    master->on_event = [this](canopen::NmtMasterEvent event, NodeId node_id, canopen::NmtState state) {
      if (event != canopen::NmtMasterEvent::state_changed) log.push_back(event_text(event, node_id, state));
    };
  }
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& end = bus.attach();
  nodes::Surroundings around{NodeId{5}};
  Can2053c<canopen::VirtualBus::Endpoint> module{end, around};
  canopen::VirtualBusPort port{bus};
  std::optional<canopen::Master<canopen::VirtualBusPort>> master;
  std::optional<canopen::MasterRemote<can_2053c::Device, canopen::VirtualBusPort>> inputs;
  std::vector<std::string> log;
};

TEST_F(Boot, ConfiguresWithSeveralTransfers) {
  namespace od = can_2053c::od;
  master->on_configure = [&](NodeId) -> canopen::Result<void> {
    if (const auto done = inputs->write<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(500)); !done)
      return done;
    return inputs->write<od::guard_time>(canopen::raw(250));
  };
  master->start();
  master->poll(50ms);
  EXPECT_EQ(canopen::to_raw(module.node().get<od::guard_time>()), 250);
  EXPECT_EQ(module.node().state(), canopen::NmtState::operational);
  EXPECT_EQ(log.back(), "node 5: not watched: no heartbeat time and no guard time in the network list");
}

TEST_F(Boot, TellsWhyTheConfigurationFailed) {
  namespace od = can_2053c::od;
  master->on_configure = [&](NodeId node_id) { return master->download(node_id, 0x5FFF, 0, {}); };
  master->start();
  master->poll(50ms);
  EXPECT_EQ(log.back(), "node 5: configuration failed: 0602 0000h, object does not exist");
  EXPECT_EQ(module.node().state(), canopen::NmtState::pre_operational);
}

TEST_F(Boot, ConfiguresWithoutWaiting) {
  namespace od = can_2053c::od;
  const std::array<std::uint8_t, 2> value{0xFA, 0};
  master->on_configure = [&](NodeId node_id) -> std::optional<canopen::Result<void>> {
    EXPECT_TRUE(master->begin_download(node_id, 0x100C, 0, value, [&, node_id](canopen::Result<void> first) {
      EXPECT_TRUE(first);
      EXPECT_TRUE(master->begin_upload(node_id, 0x100C, 0, [&, node_id](const auto& read) {
        EXPECT_EQ(*read, std::vector<std::uint8_t>(value.begin(), value.end()));
        log.push_back("configured");
        master->configured(node_id, canopen::ok);
      }));
    }));
    return std::nullopt;
  };
  master->start();
  master->poll(50ms);
  EXPECT_EQ(canopen::to_raw(module.node().get<od::guard_time>()), 250);
  ASSERT_GE(log.size(), 3u);
  EXPECT_EQ(log[log.size() - 3], "configured");
  EXPECT_EQ(log[log.size() - 2], "node 5: booted");
}

TEST_F(Boot, ReadsTheCobIdsBeforeTheSlaveIsStarted) {
  namespace od = can_2053c::od;
  using CobId = od::tpdo_communication_parameter_1::cob_id_used_by_tpdo;
  std::vector<int> got;
  master->start();
  master->poll(50ms);
  ASSERT_TRUE(inputs->on_pdo<can_2053c::Tpdo1>([&](auto low, auto high) { got = {low.raw(), high.raw()}; }));
  master->on_configure = [&](NodeId) -> canopen::Result<void> {
    if (const auto done = inputs->write<CobId>(canopen::raw(0x8000'0185u)); !done) return done;
    return inputs->write<CobId>(canopen::raw(0x0000'01C5u));
  };
  module.set_digital(1, 0x80);
  master->boot(NodeId{5});
  master->poll(50ms);
  EXPECT_EQ(got, (std::vector<int>{0, 0x80})) << "the one that is sent with the start";
}

TEST_F(Boot, EndsARequestToANodeThatIsSilentAndRefusesThoseThatDoNotFit) {
  EXPECT_EQ(master->upload(NodeId{9}, 0x1000, 0).abort_code(), canopen::AbortCode::timeout);
  int refused = 0;
  for (std::size_t i = 0; i <= master->max_requests + 1; ++i) {
    refused += master->begin_upload(NodeId{9}, 0x1000, 0, {}) ? 0 : 1;
  }
  EXPECT_EQ(refused, 1) << "one runs, the others wait";
}

TEST(PlantText, AFailedBootUpHasTheLineThatItContradicts) {
  using canopen::BootStatus;
  constexpr NodeId axis{5};
  constexpr canopen::PlantPlace places[] = {
      {NodeId{4}, 0x1018, 2, "eds/io.eds", 70}, {axis, 0, 0, "plant.json", 7},
      {axis, 0x1018, 2, "eds/drive.eds", 120},  {axis, 0x1017, 0, "plant.json", 8},
      {axis, 0x2001, 3, "plant.json", 9},
  };
  const auto line = [&](const canopen::BootResult& result) {
    canopen::PlantFault fault;
    fault.boot = result;
    const std::string text = fault_text({"axis1", axis}, fault, places);
    return text.substr(0, text.find(": axis1: "));
  };
  EXPECT_EQ(line({BootStatus::product_code, canopen::ok, 0x1018, 2, 0x10001, 0x20001}), "eds/drive.eds:120");
  EXPECT_EQ(line({BootStatus::configuration, canopen::AbortCode::value_too_high, 0x2001, 3}), "plant.json:9");
  EXPECT_EQ(line({BootStatus::no_heartbeat}), "plant.json:8");
  // Of the node: it does not answer, or an entry that no file states.
  EXPECT_EQ(line({BootStatus::no_response, canopen::AbortCode::timeout, 0x1018, 2}), "plant.json:7");
  EXPECT_EQ(line({BootStatus::configuration, canopen::AbortCode::value_too_high, 0x2002, 0}), "plant.json:7");
  EXPECT_EQ(fault_text({"", NodeId{9}}, {}, places).substr(0, 8), "node 9: ");
}

TEST(MasterText, TellsNodeEntryReasonAndNumbers) {
  using canopen::BootStatus;
  EXPECT_EQ(boot_text(NodeId{5}, {BootStatus::booted}), "node 5: booted");
  EXPECT_EQ(boot_text(NodeId{5}, {BootStatus::no_response, canopen::AbortCode::timeout, 0x1017}),
            "node 5: no answer: 1017h:00: 0504 0000h, SDO protocol timed out");
  EXPECT_EQ(boot_text(NodeId{5}, {BootStatus::product_code, canopen::ok, 0x1018, 2, 0x10001, 0x20001}),
            "node 5: product code 1018h:02 is not the one of 1F86h: expected 00010001h, seen 00020001h");
  EXPECT_EQ(boot_text(NodeId{5}, {BootStatus::configuration, canopen::AbortCode::value_too_high, 0x2001, 3}),
            "node 5: configuration failed: 2001h:03: 0609 0031h, value too high");
  EXPECT_EQ(event_text(canopen::NmtMasterEvent::lost, NodeId{5}, canopen::NmtState::operational),
            "node 5: lost, last state operational");
  EXPECT_EQ(event_text(canopen::NmtMasterEvent::boot_up, NodeId{5}, canopen::NmtState::initialisation),
            "node 5: boot-up");
}

}  // namespace
