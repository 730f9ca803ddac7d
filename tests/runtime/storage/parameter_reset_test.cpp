/// 1010h and 1011h: when stored and default values take effect, and how they follow the node-ID.
#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <stored_device/device.hpp>

#include "parameter_storage_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;
using canopen::NodeId;
using canopen::Storing;
using storage_bench::change;
using storage_bench::defaults;
using storage_bench::load_all;
using storage_bench::loaded_all;
using storage_bench::powered;
using storage_bench::Ranges;
using storage_bench::ranges;
using storage_bench::save_all;
namespace od = stored_device::od;

// Resets

TEST(StoreParameters, ResetNodeBringsStoredValues) {
  MemoryStorage storage;
  auto device = powered(storage);
  change(device);
  device.ask(save_all);
  device.ask("605 23 83 60 00 63 00 00 00");
  device.ask("605 2B 17 10 00 63 00 00 00");
  EXPECT_EQ(device.ask(bench::reset_node), "705 00");
  EXPECT_EQ(ranges(device), (Ranges{2048, 7, 8, 9}));
}

TEST(StoreParameters, ResetCommunicationBringsThoseOfTheCommunicationProfile) {
  MemoryStorage storage;
  auto device = powered(storage);
  change(device);
  device.ask(save_all);
  device.ask("605 23 83 60 00 63 00 00 00");
  device.ask("605 2B 17 10 00 63 00 00 00");
  EXPECT_EQ(device.ask(bench::reset_communication), "705 00");
  EXPECT_EQ(ranges(device), (Ranges{2048, 7, 99, 9}));
}

TEST(RestoreDefaultParameters, TakesEffectWithTheNextReset) {
  MemoryStorage storage;
  auto device = powered(storage);
  change(device);
  device.ask(save_all);
  EXPECT_EQ(device.ask(load_all), loaded_all);
  EXPECT_EQ(ranges(device), (Ranges{2048, 7, 8, 9}));
  EXPECT_EQ(device.ask(bench::reset_node), "705 00");
  EXPECT_EQ(ranges(device), defaults);
}

TEST(RestoreDefaultParameters, TakesEffectWithTheNextPowerOn) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
    device.ask(load_all);
  }
  EXPECT_EQ(ranges(powered(storage)), defaults);
}

TEST(RestoreDefaultParameters, OfTheCommunicationTakesEffectWithResetCommunication) {
  MemoryStorage storage;
  auto device = powered(storage);
  change(device);
  device.ask(save_all);
  EXPECT_EQ(device.ask("605 23 11 10 02 6C 6F 61 64"), "585 60 11 10 02 00 00 00 00");
  device.ask(bench::reset_communication);
  EXPECT_EQ(ranges(device), (Ranges{0, 7, 8, 9}));
}

TEST(RestoreDefaultParameters, RestoresTheRangeOfItsSubIndex) {
  struct Row {
    const char* request;
    Ranges left;
  };
  for (const Row& row :
       {Row{"605 23 11 10 01 6C 6F 61 64", defaults}, Row{"605 23 11 10 02 6C 6F 61 64", {0, 7, 8, 9}},
        Row{"605 23 11 10 03 6C 6F 61 64", {2048, 7, 1000, 9}}, Row{"605 23 11 10 04 6C 6F 61 64", {2048, -5, 8, 9}}}) {
    MemoryStorage storage;
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
    device.ask(row.request);
    device.ask(bench::reset_node);
    EXPECT_EQ(ranges(device), row.left) << row.request;
    EXPECT_EQ(ranges(powered(storage)), row.left) << row.request;
  }
}

TEST(RestoreDefaultParameters, WithNothingStoredWritesNothing) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.ask(load_all), loaded_all);
  EXPECT_EQ(storage.commits, 0);
}

struct NeedsPowerCycle : stored_device::Device {
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions departures;
    departures.restore_needs_power_cycle = true;
    return departures;
  }();
};

TEST(RestoreDefaultParameters, MayWaitForThePowerCycle) {
  MemoryStorage storage;
  {
    auto device = powered<NeedsPowerCycle>(storage);
    change(device);
    device.ask(save_all);
    device.ask("605 23 83 60 00 63 00 00 00");
    EXPECT_EQ(device.ask(load_all), loaded_all);
    device.ask(bench::reset_node);
    EXPECT_EQ(ranges(device), (Ranges{2048, 7, 8, 9})) << "the stored values stay in use";
    device.ask("605 23 83 60 00 64 00 00 00");
    device.ask("605 23 10 10 03 73 61 76 65");
    device.ask(bench::reset_node);
    EXPECT_EQ(ranges(device), (Ranges{2048, 7, 100, 9}));
  }
  auto device = powered<NeedsPowerCycle>(storage);
  EXPECT_EQ(ranges(device), (Ranges{0, -5, 100, 0})) << "stored after the command";
  device.ask(bench::reset_node);
  EXPECT_EQ(ranges(device), (Ranges{0, -5, 100, 0}));
  device.ask("605 23 10 10 04 73 61 76 65");
  EXPECT_EQ(ranges(powered<NeedsPowerCycle>(storage)), (Ranges{0, -5, 100, 0})) << "what was given up stays so";
}

// Node-ID

TEST(StoreParameters, LetsDefaultCobIdsFollowANewNodeId) {
  MemoryStorage storage;
  auto device = powered(storage);
  device.ask("605 23 00 18 01 85 02 00 80");
  device.ask("605 23 00 18 01 90 02 00 00");
  device.ask(save_all);
  device.node.start(NodeId{9}, device.now);
  EXPECT_EQ(device.bus.take(), "709 00");
  EXPECT_EQ(device.ask("609 40 14 10 00 00 00 00 00"), "589 43 14 10 00 89 00 00 00");
  EXPECT_EQ(device.ask("609 40 00 14 01 00 00 00 00"), "589 43 00 14 01 09 02 00 00");
  EXPECT_EQ(device.ask("609 40 03 20 00 00 00 00 00"), "589 4F 03 20 00 19 00 00 00");
  EXPECT_EQ(device.ask("609 40 00 18 01 00 00 00 00"), "589 43 00 18 01 90 02 00 00") << "set by hand";
}

TEST(StoreParameters, KeepsACobIdThatEqualsTheDefaultOfANewNodeId) {
  MemoryStorage storage;
  auto device = powered(storage);
  device.ask("605 23 00 14 01 05 02 00 80");
  device.ask("605 23 00 14 01 09 02 00 00");
  device.ask(save_all);
  device.node.start(NodeId{9}, device.now);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>()), 0x209u);
  device.node.start(NodeId{5}, device.now);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>()), 0x209u);
}

TEST(StoreParameters, RemembersTheNodeIdOfEachRange) {
  MemoryStorage storage;
  auto device = powered(storage);
  device.ask("605 23 10 10 04 73 61 76 65");
  device.node.start(NodeId{9}, device.now);
  device.ask("609 23 10 10 02 73 61 76 65");
  device.node.start(NodeId{7}, device.now);
  EXPECT_EQ(device.node.get<od::station_address>(), 0x17);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::cob_id_emcy>()), 0x87u);
}

struct BoundToNodeId : stored_device::Device {
  static constexpr Storing storing(std::uint16_t index, std::uint8_t) {
    return index == 0x1005 || index == 0x1014 ? Storing::with_node_id : Storing::by_access;
  }
};

TEST(StoreParameters, MayCountForOneNodeIdOnly) {
  MemoryStorage storage;
  auto device = powered<BoundToNodeId>(storage);
  device.ask("605 23 05 10 00 81 00 00 00");
  device.ask("605 23 14 10 00 85 00 00 80");  // not valid while its CAN-ID changes
  device.ask("605 23 14 10 00 A0 00 00 00");
  device.ask("605 2B 17 10 00 00 08 00 00");
  device.ask(save_all);
  device.ask(load_all);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.ask("605 40 05 10 00 00 00 00 00"), "585 43 05 10 00 81 00 00 00") << "load leaves it";
  EXPECT_EQ(device.ask("605 40 14 10 00 00 00 00 00"), "585 43 14 10 00 A0 00 00 00");
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 00 00 00");
  device.node.start(NodeId{9}, device.now);
  device.bus.take();
  EXPECT_EQ(device.ask("609 40 05 10 00 00 00 00 00"), "589 43 05 10 00 80 00 00 00");
  EXPECT_EQ(device.ask("609 40 14 10 00 00 00 00 00"), "589 43 14 10 00 89 00 00 00");
}

}  // namespace
