/// 1010h, 1011h and 1020h: what is stored, what is rejected, and when stored and default values take effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <canopen/host/memory_storage.hpp>
#include <every_service/device.hpp>
#include <longer_label/device.hpp>
#include <stored_device/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::MemoryStorage;
using canopen::NodeId;
using canopen::Storing;
namespace od = stored_device::od;
using namespace std::chrono_literals;

/// A device at power-on, with the values that were stored before.
template <class Device = stored_device::Device, class... Handlers>
using Powered = bench::Bench<Device, canopen::StoredIn<MemoryStorage>, Handlers...>;

template <class Device = stored_device::Device, class... Handlers>
Powered<Device, Handlers...> powered(MemoryStorage& storage, Handlers... handlers) {
  return Powered<Device, Handlers...>{canopen::stored_in(storage), std::move(handlers)...};
}

constexpr auto save_all = "605 23 10 10 01 73 61 76 65";
constexpr auto saved_all = "585 60 10 10 01 00 00 00 00";
constexpr auto load_all = "605 23 11 10 01 6C 6F 61 64";
constexpr auto loaded_all = "585 60 11 10 01 00 00 00 00";

// Commands

TEST(StoreParameters, KeepsValuesOverALossOfPower) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    EXPECT_EQ(device.ask("605 23 83 60 00 D0 07 00 00"), "585 60 83 60 00 00 00 00 00");
    EXPECT_EQ(device.ask("605 27 00 20 00 FB FF FF 00"), "585 60 00 20 00 00 00 00 00");
    EXPECT_EQ(device.ask("605 2B 17 10 00 64 00 00 00"), "585 60 17 10 00 00 00 00 00 | 705 7F");
    EXPECT_EQ(device.ask("605 27 01 20 00 61 62 63 00"), "585 60 01 20 00 00 00 00 00");
    EXPECT_EQ(device.ask("605 2B 05 20 02 FE FF 00 00"), "585 60 05 20 02 00 00 00 00");
    EXPECT_EQ(device.ask(save_all), saved_all);
  }
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 40 83 60 00 00 00 00 00"), "585 43 83 60 00 D0 07 00 00");
  EXPECT_EQ(device.ask("605 40 00 20 00 00 00 00 00"), "585 47 00 20 00 FB FF FF 00");
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 64 00 00 00");
  EXPECT_EQ(device.ask("605 40 01 20 00 00 00 00 00"), "585 47 01 20 00 61 62 63 00");
  EXPECT_EQ(device.ask("605 40 05 20 02 00 00 00 00"), "585 4B 05 20 02 FE FF 00 00");
}

TEST(StoreParameters, TellsWhatItCanDo) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 40 10 10 00 00 00 00 00"), "585 4F 10 10 00 06 00 00 00");
  EXPECT_EQ(device.ask("605 40 10 10 01 00 00 00 00"), "585 43 10 10 01 01 00 00 00");
  EXPECT_EQ(device.ask("605 40 10 10 06 00 00 00 00"), "585 43 10 10 06 02 00 00 00");
  EXPECT_EQ(device.ask("605 40 11 10 01 00 00 00 00"), "585 43 11 10 01 01 00 00 00");
}

TEST(StoreParameters, RefusesAnotherSignature) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 23 10 10 01 73 61 76 64"), "585 80 10 10 01 20 00 00 08");
  EXPECT_EQ(device.ask("605 23 10 10 01 6C 6F 61 64"), "585 80 10 10 01 20 00 00 08");
  EXPECT_EQ(device.ask("605 23 11 10 01 73 61 76 65"), "585 80 11 10 01 20 00 00 08");
  EXPECT_EQ(device.ask("605 2B 10 10 01 73 61 00 00"), "585 80 10 10 01 13 00 07 06");
  EXPECT_EQ(device.ask("605 2F 10 10 00 01 00 00 00"), "585 80 10 10 00 02 00 01 06");
  EXPECT_EQ(device.ask("605 23 10 10 07 73 61 76 65"), "585 80 10 10 07 11 00 09 06");
  EXPECT_EQ(storage.commits, 0);
}

struct AnotherAbortCode : stored_device::Device {
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions departures;
    departures.storage_signature_abort_code = 0x0800'0022;
    return departures;
  }();
};

TEST(StoreParameters, RefusesAnotherSignatureInTheWordsOfTheDevice) {
  MemoryStorage storage;
  auto device = powered<AnotherAbortCode>(storage);
  EXPECT_EQ(device.ask("605 23 10 10 01 00 00 00 00"), "585 80 10 10 01 22 00 00 08");
  EXPECT_EQ(device.ask("605 23 11 10 02 00 00 00 00"), "585 80 11 10 02 22 00 00 08");
  EXPECT_EQ(device.ask(save_all), saved_all);
}

TEST(StoreParameters, RefusesWhatTheDeviceDoesNotDoOnCommand) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 23 10 10 06 73 61 76 65"), "585 80 10 10 06 20 00 00 08");
  EXPECT_EQ(device.ask("605 23 11 10 06 6C 6F 61 64"), "585 80 11 10 06 20 00 00 08");
}

TEST(StoreParameters, TellsThatTheStorageHasFailed) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 23 83 60 00 D0 07 00 00");
    EXPECT_EQ(device.ask(save_all), saved_all);
    device.ask("605 23 83 60 00 01 00 00 00");
    storage.fails_to_commit = true;
    EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 00 00 06 06");
    EXPECT_EQ(device.ask(load_all), "585 80 11 10 01 00 00 06 06");
  }
  auto device = powered(storage);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 2000u);
}

TEST(StoreParameters, IsRefusedWithoutAStorage) {
  bench::Bench<stored_device::Device> device;
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 20 00 00 08");
  EXPECT_EQ(device.ask(load_all), "585 80 11 10 01 20 00 00 08");
  EXPECT_EQ(device.ask("605 40 10 10 01 00 00 00 00"), "585 43 10 10 01 01 00 00 00");
}

TEST(StoreParameters, TakesTheSignatureInSegments) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 21 10 10 01 04 00 00 00"), saved_all);
  EXPECT_EQ(storage.commits, 0);
  EXPECT_EQ(device.ask("605 07 73 61 76 65 00 00 00"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(storage.commits, 1);
}

TEST(StoreParameters, AsksTheApplicationFirst) {
  MemoryStorage storage;
  bool motor_on = true;
  auto device = powered(storage, canopen::on_write<od::store_parameters<1>>(
                                     [&](std::uint32_t) { return motor_on ? AbortCode::device_state : canopen::ok; }));
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 22 00 00 08");
  EXPECT_EQ(storage.commits, 0);
  motor_on = false;
  EXPECT_EQ(device.ask(save_all), saved_all);
  EXPECT_EQ(storage.commits, 1);
}

TEST(StoreParameters, LeavesOtherSubIndicesToTheApplication) {
  MemoryStorage storage;
  int calls = 0;
  auto device = powered(storage, canopen::on_write<od::store_parameters<5>>([&](std::uint32_t) { ++calls; }));
  EXPECT_EQ(device.ask("605 23 10 10 05 00 00 00 00"), "585 80 10 10 05 20 00 00 08");
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(device.ask("605 23 10 10 05 73 61 76 65"), "585 60 10 10 05 00 00 00 00");
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(device.ask("605 23 11 10 05 6C 6F 61 64"), "585 80 11 10 05 00 00 06 06") << "nobody restores this";
  EXPECT_EQ(storage.commits, 0);
}

TEST(StoreParameters, IsThereForTheApplication) {
  MemoryStorage storage;
  auto device = powered(storage);
  EXPECT_EQ(device.node.set<od::profile_acceleration>(7), canopen::ok);
  EXPECT_EQ(device.node.save(), canopen::ok);
  EXPECT_EQ(device.node.set<od::profile_acceleration>(8), canopen::ok);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 7u);
  EXPECT_EQ(device.node.restore(3), canopen::ok);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 1000u);
  EXPECT_EQ(device.node.save(5), AbortCode::hardware);
}

// What is stored

/// One value of each range.
void change(auto& device) {
  device.ask("605 2B 17 10 00 00 08 00 00");
  device.ask("605 23 00 20 00 07 00 00 00");
  device.ask("605 27 00 20 00 07 00 00 00");
  device.ask("605 23 83 60 00 08 00 00 00");
  device.ask("605 2B 00 A0 00 09 00 00 00");
}

struct Ranges {
  int communication, manufacturer, application, other;
  friend bool operator==(const Ranges&, const Ranges&) = default;
};
constexpr Ranges defaults{0, -5, 1000, 0};

template <class Bench>
Ranges ranges(const Bench& device) {
  return {device.node.template get<od::producer_heartbeat_time>(), device.node.template get<od::gain>(),
          static_cast<int>(device.node.template get<od::profile_acceleration>()),
          device.node.template get<od::network_variable>()};
}

TEST(StoreParameters, KeepsTheRangeOfItsSubIndex) {
  struct Row {
    const char* request;
    Ranges kept;
  };
  for (const Row& row :
       {Row{"605 23 10 10 01 73 61 76 65", {2048, 7, 8, 9}}, Row{"605 23 10 10 02 73 61 76 65", {2048, -5, 1000, 0}},
        Row{"605 23 10 10 03 73 61 76 65", {0, -5, 8, 0}}, Row{"605 23 10 10 04 73 61 76 65", {0, 7, 1000, 0}}}) {
    MemoryStorage storage;
    {
      auto device = powered(storage);
      change(device);
      EXPECT_EQ(device.ask(row.request).substr(0, 6), "585 60");
    }
    EXPECT_EQ(ranges(powered(storage)), row.kept) << row.request;
  }
}

TEST(StoreParameters, LeavesWhatOtherSubIndicesHaveStored) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
    device.ask("605 23 83 60 00 63 00 00 00");
    device.ask("605 27 00 20 00 63 00 00 00");
    device.ask("605 23 10 10 03 73 61 76 65");
  }
  EXPECT_EQ(ranges(powered(storage)), (Ranges{2048, 7, 99, 9}));
}

TEST(StoreParameters, KeepsParametersAndNoProcessData) {
  using Layout = canopen::ParameterLayout<stored_device::Device>;
  for (const auto& [index, sub_index] : {std::pair{0x1005, 0},
                                         {0x1014, 0},
                                         {0x1020, 1},
                                         {0x1400, 1},
                                         {0x1400, 2},
                                         {0x1600, 0},
                                         {0x1600, 3},
                                         {0x1800, 5},
                                         {0x2003, 0},
                                         {0x2005, 3},
                                         {0x6083, 0}}) {
    EXPECT_TRUE(Layout::stores(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub_index))) << index;
  }
  for (const auto& [index, sub_index, why] : {std::tuple{0x1001, 0, "an error"},
                                              {0x1003, 0, "errors"},
                                              {0x1003, 1, "an error"},
                                              {0x1010, 1, "a command"},
                                              {0x1013, 0, "a time"},
                                              {0x2002, 0, "write-only"},
                                              {0x2004, 0, "a DOMAIN"},
                                              {0x6040, 0, "an output, rww"},
                                              {0x6041, 0, "an input, ro"},
                                              {0x60FF, 0, "an output: in an RPDO"}}) {
    EXPECT_FALSE(Layout::stores(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub_index))) << why;
  }
  EXPECT_TRUE(Layout::stores(0x2006, 0)) << "by the options";
}

TEST(StoreParameters, DoesNotStoreCommandsToTheDrive) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 2B 40 60 00 0F 00 00 00");
    device.ask("605 23 FF 60 00 E8 03 00 00");
    device.node.emergency(0x4210, canopen::ErrorRegister::temperature);
    device.pass(0s);
    device.ask(save_all);
  }
  auto device = powered(storage);
  EXPECT_EQ(device.ask("605 40 40 60 00 00 00 00 00"), "585 4B 40 60 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 FF 60 00 00 00 00 00"), "585 43 FF 60 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 01 10 00 00 00 00 00"), "585 4F 01 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 40 03 10 00 00 00 00 00"), "585 4F 03 10 00 00 00 00 00");
}

TEST(StoreParameters, KeepsTheMappingAndTheCobIdOfAPdo) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 23 00 14 01 05 02 00 80");
    device.ask("605 2F 00 16 00 00 00 00 00");
    device.ask("605 23 00 16 01 20 00 83 60");
    device.ask("605 2F 00 16 00 01 00 00 00");
    device.ask("605 23 00 14 01 33 03 00 00");
    EXPECT_EQ(device.ask(save_all), saved_all);
  }
  auto device = powered(storage);
  device.ask(bench::start);
  device.ask("333 2A 00 00 00");
  EXPECT_EQ(device.ask("605 40 83 60 00 00 00 00 00"), "585 43 83 60 00 2A 00 00 00");
}

TEST(StoreParameters, StartsTheHeartbeatOfAStoredTime) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 2B 17 10 00 64 00 00 00");
    device.ask(save_all);
  }
  auto device = powered(storage);
  EXPECT_EQ(device.pass(100ms), "705 7F");
}

struct Chosen : stored_device::Device {
  static constexpr Storing storing(std::uint16_t index, std::uint8_t sub_index) {
    if (index == 0x6083) return Storing::never;
    if (index == 0x6040) return Storing::always;
    if (index == 0x2005 && sub_index == 2) return Storing::never;
    return Storing::by_access;
  }
};

TEST(StoreParameters, KeepsWhatTheOptionsSay) {
  MemoryStorage storage;
  {
    auto device = powered<Chosen>(storage);
    device.ask("605 2B 40 60 00 0F 00 00 00");
    device.ask("605 23 83 60 00 D0 07 00 00");
    device.ask("605 2B 05 20 01 01 00 00 00");
    device.ask("605 2B 05 20 02 02 00 00 00");
    device.ask("605 2B 05 20 03 03 00 00 00");
    device.ask(save_all);
  }
  auto device = powered<Chosen>(storage);
  EXPECT_EQ(device.node.get<od::controlword>(), 0x0F);
  EXPECT_EQ(device.node.get<od::profile_acceleration>(), 1000u);
  EXPECT_EQ(device.node.get<od::table<1>>(), 1);
  EXPECT_EQ(device.node.get<od::table<2>>(), 0);
  EXPECT_EQ(device.node.get<od::table<3>>(), 3);
}

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
  EXPECT_EQ(device.node.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>(), 0x209u);
  device.node.start(NodeId{5}, device.now);
  EXPECT_EQ(device.node.get<od::rpdo_communication_parameter_1::cob_id_used_by_rpdo>(), 0x209u);
}

TEST(StoreParameters, RemembersTheNodeIdOfEachRange) {
  MemoryStorage storage;
  auto device = powered(storage);
  device.ask("605 23 10 10 04 73 61 76 65");
  device.node.start(NodeId{9}, device.now);
  device.ask("609 23 10 10 02 73 61 76 65");
  device.node.start(NodeId{7}, device.now);
  EXPECT_EQ(device.node.get<od::station_address>(), 0x17);
  EXPECT_EQ(device.node.get<od::cob_id_emcy>(), 0x87u);
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

// Another dictionary, a damaged storage

TEST(StoreParameters, IsNotTakenByAnotherDictionary) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
  }
  auto device = powered<longer_label::Device>(storage);
  EXPECT_EQ(ranges(device), (Ranges{2048, -5, 8, 9})) << "a string of 2000h..5FFFh is longer";
  device.ask("605 23 10 10 03 73 61 76 65");
  EXPECT_EQ(ranges(powered<longer_label::Device>(storage)), (Ranges{2048, -5, 8, 9}));
  EXPECT_EQ(ranges(powered(storage)), (Ranges{2048, -5, 8, 9})) << "what nobody reads goes with the next save";
}

TEST(StoreParameters, TellsThatStoredValuesAreLost) {
  MemoryStorage storage;
  storage.damaged = true;
  bench::RecordingBus bus;
  auto node = canopen::make_node<stored_device::Device>(bus, NodeId{5}, canopen::stored_in(storage));
  node.start(canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00 | 085 00 63 01 00 00 00 00 00");
  EXPECT_EQ(node.get<od::error_register>(), 0x01);
  node.on_frame(bench::frame(bench::reset_communication), canopen::TimePoint{});
  EXPECT_EQ(bus.take(), "705 00 | 085 00 63 01 00 00 00 00 00") << "until the next power-on";
}

TEST(StoreParameters, StartsWithDefaultsWhereTheStorageCannotBeRead) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    change(device);
    device.ask(save_all);
  }
  storage.fails_to_read = true;
  auto device = powered(storage);
  EXPECT_EQ(ranges(device), defaults);
  EXPECT_EQ(device.node.get<od::error_register>(), 0x01);
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 00 00 06 06");
}

// Values that were stored with other limits

/// The device with other limits of 6083h, which are 1 and 4294967295 in the EDS.
template <std::uint32_t Low, std::uint32_t High>
struct WithLimits : stored_device::Device {
  static constexpr auto limits = [] {
    std::array<canopen::Limits, std::size(stored_device::table::limits)> rows{};
    std::ranges::copy(stored_device::table::limits, rows.begin());
    for (canopen::Limits& row : rows) {
      if (row.key == canopen::object_key(0x6083, 0)) row = {row.key, Low, High};
    }
    return rows;
  }();
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = stored_device::dictionary;
    copy.limits = limits;
    return copy;
  }();
};

template <class Device>
std::string acceleration_after(MemoryStorage storage) {
  auto device = powered<Device>(storage);
  EXPECT_EQ(device.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 64 00 00 00") << "it is in another section";
  return device.ask("605 40 83 60 00 00 00 00 00");
}

TEST(StoreParameters, DoesNotTakeValuesThatWereStoredUnderOtherLimits) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    device.ask("605 23 83 60 00 D0 07 00 00");
    device.ask("605 2B 17 10 00 64 00 00 00");
    EXPECT_EQ(device.ask(save_all), saved_all);
  }
  const std::string stored = "585 43 83 60 00 D0 07 00 00";
  const std::string by_default = "585 43 83 60 00 E8 03 00 00";
  EXPECT_EQ((acceleration_after<WithLimits<1, 0xFFFF'FFFF>>(storage)), stored);
  EXPECT_EQ((acceleration_after<WithLimits<2, 0xFFFF'FFFF>>(storage)), by_default);
  EXPECT_EQ((acceleration_after<WithLimits<1, 0xFFFF'FFFE>>(storage)), by_default);
}

// The signature of a section depends on each limit, also on those of more than 32 bits.
template <std::uint64_t Low, std::uint64_t High>
struct WithWideLimits : sample::Device {
  static constexpr canopen::WideLimits wide_limits[] = {{canopen::object_key(0x2007, 0x00), Low, High},
                                                        sample::table::wide_limits[1]};
  static constexpr canopen::Dictionary dictionary = [] {
    canopen::Dictionary copy = sample::dictionary;
    copy.wide_limits = wide_limits;
    return copy;
  }();
};
template <class Device>
constexpr auto signatures = canopen::ParameterLayout<Device>::signatures;
constexpr std::uint64_t wide_low = sample::table::wide_limits[0].low;
constexpr std::uint64_t wide_high = sample::table::wide_limits[0].high;
static_assert(signatures<WithWideLimits<wide_low, wide_high>> == signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low + 1, wide_high>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low + (1ull << 32), wide_high>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low, wide_high + 1>> != signatures<sample::Device>);
static_assert(signatures<WithWideLimits<wide_low, wide_high + (1ull << 32)>> != signatures<sample::Device>);

/// A device whose only node-ID-dependent default has 64 bits: 2008h.
struct WideFollower : sample::Device {
  static constexpr canopen::NodeIdRelative rows[] = {
      {canopen::entry::offset_of(sample::dictionary.find(0x2008, 0)), 8}};
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_communication() { return {}; }
  static constexpr std::span<const canopen::NodeIdRelative> node_id_relative_application() { return rows; }
};

TEST(StoreParameters, LetsAValueOf64BitsFollowTheNodeId) {
  using Node = canopen::Node<WideFollower, bench::RecordingBus, canopen::StoredIn<MemoryStorage>>;
  constexpr std::uint64_t high_bit = 1ull << 32;
  for (const std::uint64_t value : {std::uint64_t{5}, high_bit + 5, std::uint64_t{6}}) {
    MemoryStorage storage;
    bench::RecordingBus bus;
    Node node{bus, NodeId{5}, canopen::stored_in(storage)};
    node.start({});
    EXPECT_EQ(node.get<sample::od::unsigned64_value>(), 5u) << "the default";
    node.set<sample::od::unsigned64_value>(value);
    EXPECT_EQ(node.save(), canopen::ok);
    Node same{bus, NodeId{5}, canopen::stored_in(storage)};
    same.start({});
    EXPECT_EQ(same.get<sample::od::unsigned64_value>(), value);
    Node other{bus, NodeId{9}, canopen::stored_in(storage)};
    other.start({});
    EXPECT_EQ(other.get<sample::od::unsigned64_value>(), value == 5 ? 9 : value);
  }
}

TEST(StoreParameters, GivesUpAnErrorBehaviourThatIsReserved) {
  MemoryStorage storage;
  const std::array<std::uint8_t, 1> reserved{3};
  {
    auto device = powered<every_service::Device>(storage);
    ASSERT_EQ(device.node.set(0x1029, 1, reserved), canopen::ok) << "the application may";
    ASSERT_EQ(device.node.save(), canopen::ok);
  }
  auto device = powered<every_service::Device>(storage);
  EXPECT_EQ(device.ask("605 40 29 10 01 00 00 00 00"), "585 4F 29 10 01 00 00 00 00") << "the default";
}

// Verify configuration

constexpr auto configuration_date = "605 40 20 10 01 00 00 00 00";
constexpr auto configuration_time = "605 40 20 10 02 00 00 00 00";

void configure(auto& device) {
  device.ask("605 23 83 60 00 D0 07 00 00");
  device.ask("605 23 20 10 01 34 3C 00 00");
  device.ask("605 23 20 10 02 78 56 34 00");
}

TEST(VerifyConfiguration, IsStoredWithTheConfiguration) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    configure(device);
    device.ask(save_all);
  }
  auto device = powered(storage);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00");
  EXPECT_EQ(device.ask(configuration_time), "585 43 20 10 02 78 56 34 00");
}

TEST(VerifyConfiguration, IsZeroWhenAParameterHasChanged) {
  MemoryStorage storage;
  auto device = powered(storage);
  configure(device);
  device.ask("605 23 83 60 00 D0 07 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "the same value again";
  device.ask("605 23 83 60 00 00 00 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "refused";
  device.ask("605 2B 40 60 00 06 00 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "no parameter";
  device.ask("605 23 83 60 00 D1 07 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
  EXPECT_EQ(device.ask(configuration_time), "585 43 20 10 02 00 00 00 00");
}

// CiA 301, 7.5.2.23: 1020h becomes 0 when anything but the configuration tool changes a value of the configuration.
TEST(VerifyConfiguration, IsZeroWhenAWriteHandlerSetsItsObject) {
  MemoryStorage storage;
  auto device = powered(storage, canopen::on_write<od::profile_acceleration>([](auto& node, std::uint32_t value) {
                          return node.template set<od::profile_acceleration>(value < 2000 ? value : 2000);
                        }));
  configure(device);
  device.ask("605 23 83 60 00 D1 07 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "2000 it was before";
  device.ask("605 23 83 60 00 CF 07 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
  EXPECT_EQ(device.ask(configuration_time), "585 43 20 10 02 00 00 00 00");
}

TEST(VerifyConfiguration, IsZeroWhenAWriteHandlerSetsAnotherObject) {
  MemoryStorage storage;
  auto device = powered(storage, canopen::on_write<od::controlword>([](auto& node, std::uint16_t value) {
                          const std::array<std::uint8_t, 4> acceleration{static_cast<std::uint8_t>(value), 7, 0, 0};
                          return node.set(0x6083, 0, acceleration);
                        }));
  configure(device);
  device.ask("605 2B 40 60 00 D0 00 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "2000 it was before";
  device.ask("605 2B 40 60 00 D1 00 00 00");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
}

TEST(VerifyConfiguration, IsZeroWhenTheApplicationSetsAParameter) {
  MemoryStorage storage;
  auto device = powered(storage);
  configure(device);
  EXPECT_EQ(device.node.set<od::profile_acceleration>(2000), canopen::ok);
  EXPECT_EQ(device.node.set<od::controlword>(6), canopen::ok);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00") << "the same value, and no parameter";
  EXPECT_EQ(device.node.set<od::profile_acceleration>(2001), canopen::ok);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
}

TEST(VerifyConfiguration, StaysWithWhatTheApplicationSetsInInitialisation) {
  MemoryStorage storage;
  auto device = powered(storage, canopen::on_state([](auto& node, canopen::NmtState state) {
                          if (state != canopen::NmtState::initialisation) return;
                          EXPECT_EQ(node.template set<od::profile_acceleration>(3000), canopen::ok);
                        }));
  configure(device);
  device.ask(save_all);
  device.ask(bench::reset_node);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00");
}

TEST(VerifyConfiguration, IsStoredAsZeroWithARangeThatHasChanged) {
  MemoryStorage storage;
  {
    auto device = powered(storage);
    configure(device);
    device.ask(save_all);
    device.ask("605 23 83 60 00 D1 07 00 00");
    device.ask("605 23 10 10 03 73 61 76 65");
  }
  auto device = powered(storage);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
}

TEST(VerifyConfiguration, IsBackWhenAChangeWasNotSaved) {
  MemoryStorage storage;
  auto device = powered(storage);
  configure(device);
  device.ask(save_all);
  device.ask("605 23 83 60 00 D1 07 00 00");
  device.ask(bench::reset_node);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 34 3C 00 00");
}

TEST(VerifyConfiguration, IsZeroAfterARestore) {
  MemoryStorage storage;
  auto device = powered(storage);
  configure(device);
  device.ask(save_all);
  device.ask("605 23 11 10 04 6C 6F 61 64");
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
  device.ask(bench::reset_node);
  EXPECT_EQ(device.ask(configuration_date), "585 43 20 10 01 00 00 00 00");
  EXPECT_EQ(device.ask(configuration_time), "585 43 20 10 02 00 00 00 00");
}

// The node

TEST(StoreParameters, CostsNothingWithoutAStorage) {
  struct Nowhere {
    static bool send(const canopen::Frame&) { return true; }
  };
  using Without = canopen::Node<stored_device::Device, Nowhere>;
  using With = canopen::Node<stored_device::Device, Nowhere, canopen::StoredIn<MemoryStorage>>;
  EXPECT_LE(sizeof(Without) + sizeof(void*), sizeof(With));
  EXPECT_LE(sizeof(With), sizeof(Without) + 2 * sizeof(void*));
}

}  // namespace
