/// The master of docs/master.md and the drive that it boots.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cpc_tc1/cpc_tc1.hpp"
#include "master/drive_master.hpp"

namespace {

using namespace std::chrono_literals;

struct MasterAndDrive : testing::Test {
  MasterAndDrive() {
    canopen::VirtualBus::connect(end, drive);
    drive.start(bus.now());
  }
  [[nodiscard]] bool logged(std::string_view line) const { return std::ranges::find(log, line) != log.end(); }

  std::vector<std::string> log;
  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& end = bus.attach();
  nodes::Surroundings around{canopen::NodeId{5}};
  cpc_tc1_node::CpcTc1<canopen::VirtualBus::Endpoint> drive{end, around};
  canopen::VirtualBusPort port{bus};
  DriveMaster<canopen::VirtualBusPort> master{port, [this](const std::string& line) { log.push_back(line); }};
};

TEST_F(MasterAndDrive, BootsConfiguresAndListens) {
  master.run_for(500ms);
  EXPECT_TRUE(logged("node 5: booted"));
  EXPECT_EQ(drive.node().state(), canopen::NmtState::operational);
  EXPECT_EQ(canopen::to_raw(drive.node().get<cpc_tc1::od::producer_heartbeat_time>()), 150);
  EXPECT_EQ(canopen::to_raw(drive.node().get<cpc_tc1::od::tpdo_communication_parameter_2::event_timer>()), 20);
  EXPECT_EQ(master.position(), 0);
  EXPECT_TRUE(master.switch_on());
}

TEST_F(MasterAndDrive, BootsItAgainWhenItIsLostAndBack) {
  master.run_for(500ms);
  end.on_frame = nullptr;
  end.next_deadline = [] { return std::optional<canopen::TimePoint>{}; };
  master.run_for(1s);
  EXPECT_TRUE(logged("node 5: lost, last state operational"));
  EXPECT_EQ(master.position(), std::nullopt);
  log.clear();
  canopen::VirtualBus::connect(end, drive);
  master.run_for(3s);
  EXPECT_TRUE(logged("node 5: booted"));
  EXPECT_EQ(master.position(), 0);
}

}  // namespace
