/// 1010h: commands and what is stored.
#include <gtest/gtest.h>

#include <canopen/host/memory_storage.hpp>
#include <stored_device/device.hpp>

#include "parameter_storage_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using canopen::MemoryStorage;
using canopen::Storing;
using storage_bench::change;
using storage_bench::load_all;
using storage_bench::powered;
using storage_bench::Ranges;
using storage_bench::ranges;
using storage_bench::save_all;
using storage_bench::saved_all;
namespace od = stored_device::od;
using namespace std::chrono_literals;

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
  auto device = powered(storage, canopen::on_write<od::store_parameters<1>>([&](od::store_parameters<1>::type) {
                          return motor_on ? AbortCode::device_state : canopen::ok;
                        }));
  EXPECT_EQ(device.ask(save_all), "585 80 10 10 01 22 00 00 08");
  EXPECT_EQ(storage.commits, 0);
  motor_on = false;
  EXPECT_EQ(device.ask(save_all), saved_all);
  EXPECT_EQ(storage.commits, 1);
}

TEST(StoreParameters, LeavesOtherSubIndicesToTheApplication) {
  MemoryStorage storage;
  int calls = 0;
  auto device =
      powered(storage, canopen::on_write<od::store_parameters<5>>([&](od::store_parameters<5>::type) { ++calls; }));
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

// The node

TEST(StoreParameters, CostsNothingWithoutAStorage) {
  struct Nowhere {
    static bool send(const canopen::Frame&) { return true; }
  };
  using Without = bench::NodeOf<stored_device::Device, Nowhere>;
  using With = bench::NodeOf<stored_device::Device, Nowhere, canopen::StoredIn<MemoryStorage>>;
  EXPECT_LE(sizeof(Without) + sizeof(void*), sizeof(With));
  EXPECT_LE(sizeof(With), sizeof(Without) + 2 * sizeof(void*));
}

}  // namespace
