#include <gtest/gtest.h>
#include <canopen/nmt_master/network_list.hpp>

#include <array>
#include <nmt_master/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::NmtSlave;
using canopen::NodeId;
using namespace std::chrono_literals;

TEST(NetworkList, HasTheSlavesOf1F81h) {
  canopen::ObjectStore<nmt_master::Device> store;
  store.reset_communication(NodeId{1});
  std::array<NmtSlave, 4> slaves{};
  ASSERT_EQ(canopen::read_network_list(store.entries(), slaves), 3u) << "1F81h:06 lacks bit 0";

  EXPECT_EQ(slaves[0].node_id, NodeId{2});
  EXPECT_TRUE(slaves[0].has(canopen::slave_assignment::mandatory));
  EXPECT_TRUE(slaves[0].has(canopen::slave_assignment::boot));
  EXPECT_FALSE(slaves[0].has(canopen::slave_assignment::keep_alive));
  EXPECT_EQ(slaves[0].guard_time(), 100);
  EXPECT_EQ(slaves[0].life_time_factor(), 3);
  EXPECT_EQ(slaves[0].device_type, 0xF0191u);
  EXPECT_EQ(slaves[0].vendor_id, 0x1234u);
  EXPECT_EQ(slaves[0].product_code, 0x10001u);
  EXPECT_EQ(slaves[0].revision_number, 0x10002u);
  EXPECT_EQ(slaves[0].serial_number, 7u);
  EXPECT_EQ(slaves[0].heartbeat_time, 0);

  EXPECT_EQ(slaves[1].node_id, NodeId{3});
  EXPECT_EQ(slaves[1].heartbeat_time, 100) << "from 1016h";
  EXPECT_EQ(slaves[1].product_code, 0u);
  EXPECT_EQ(slaves[1].configuration_date, 15'668u);
  EXPECT_EQ(slaves[1].configuration_time, 43'200'000u);
  EXPECT_EQ(slaves[1].software, 0x10203u);
  EXPECT_EQ(slaves[1].restored_parameters, 2);
  EXPECT_TRUE(slaves[1].has(canopen::slave_assignment::software_version));
  EXPECT_FALSE(slaves[1].has(canopen::slave_assignment::software_update));
  EXPECT_TRUE(slaves[1].has(canopen::slave_assignment::restore));
  EXPECT_EQ(slaves[2].node_id, NodeId{5});
  EXPECT_TRUE(slaves[2].has(canopen::slave_assignment::keep_alive));
}

TEST(NetworkList, SaysHowManySlavesThereAreWhenNotAllFit) {
  canopen::ObjectStore<nmt_master::Device> store;
  store.reset_communication(NodeId{1});
  std::array<NmtSlave, 2> slaves{};
  EXPECT_EQ(canopen::read_network_list(store.entries(), slaves), 3u);
  EXPECT_EQ(slaves[1].node_id, NodeId{3});
}

TEST(NetworkList, HasStartUpAndBootTime) {
  canopen::ObjectStore<nmt_master::Device> store;
  store.reset_communication(NodeId{1});
  const canopen::NmtStartUp start_up = canopen::read_start_up(store.entries());
  EXPECT_TRUE(start_up.has(canopen::nmt_start_up::master));
  EXPECT_TRUE(start_up.has(canopen::nmt_start_up::start_all));
  EXPECT_TRUE(start_up.has(canopen::nmt_start_up::stop_all));
  EXPECT_FALSE(start_up.has(canopen::nmt_start_up::reset_all));
  EXPECT_EQ(start_up.boot_time, canopen::Duration{5s});
  store.set<nmt_master::od::boot_time>(canopen::from_raw<nmt_master::od::boot_time::type>(0xFFFF'FFFF));
  EXPECT_EQ(canopen::read_start_up(store.entries()).boot_time, canopen::Duration{30min});
}

TEST(NetworkList, IsEmptyWhereTheDictionaryHasNone) {
  canopen::ObjectStore<sample::Device> store;
  std::array<NmtSlave, 2> slaves{};
  EXPECT_EQ(canopen::read_network_list(store.entries(), slaves), 0u);
  EXPECT_EQ(canopen::read_start_up(store.entries()).bits, 0u);
  EXPECT_EQ(canopen::read_start_up(store.entries()).boot_time, canopen::Duration{0});
}

}  // namespace
