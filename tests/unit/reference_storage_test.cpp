/// Store and restore as the manuals of the reference devices have it.
#include <gtest/gtest.h>

#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include "bench.hpp"
#include "memory_storage.hpp"

namespace {

using bench::MemoryStorage;

template <class Device, class... Handlers>
using Powered = bench::Bench<Device, canopen::StoredIn<MemoryStorage>, Handlers...>;

// Manual 000, chapter 12, 1010h and 1011h

TEST(StorageOfManual000, RefusesAWrongSignatureByTheDeviceState) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  EXPECT_EQ(drive.ask("605 40 10 10 02 00 00 00 00"), "585 43 10 10 02 01 00 00 00");
  EXPECT_EQ(drive.ask("605 23 10 10 02 64 61 6F 6C"), "585 80 10 10 02 22 00 00 08");
  EXPECT_EQ(drive.ask("605 23 11 10 02 73 61 76 65"), "585 80 11 10 02 22 00 00 08");
  EXPECT_EQ(drive.ask("605 23 10 10 02 73 61 76 65"), "585 60 10 10 02 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 11 10 02 6C 6F 61 64"), "585 60 11 10 02 00 00 00 00");
}

TEST(StorageOfManual000, TellsThatStoringFailed) {
  MemoryStorage storage;
  storage.fails_to_commit = true;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  EXPECT_EQ(drive.ask("605 23 10 10 01 73 61 76 65"), "585 80 10 10 01 00 00 06 06");
}

TEST(StorageOfManual000, LeavesTheVirtualMachineToTheApplication) {
  MemoryStorage storage;
  bool program_stored = false;
  auto store = canopen::on_write<cpc_tc1::od::store_parameters<5>>([&](std::uint32_t) { program_stored = true; });
  Powered<cpc_tc1::Device, decltype(store)> drive{canopen::stored_in(storage), store};
  EXPECT_EQ(drive.ask("605 23 10 10 05 73 61 76 65"), "585 60 10 10 05 00 00 00 00");
  EXPECT_TRUE(program_stored);
}

// Manual 002, 9.4.10, 9.4.11, 9.4.17, 3.6.1

TEST(StorageOfManual002, ResetsLoadTheirPartOfWhatIsSaved) {
  MemoryStorage storage;
  Powered<cpd::Device> drive{canopen::stored_in(storage)};
  drive.ask("605 2B 17 10 00 00 08 00 00");
  drive.ask("605 23 20 10 01 34 3C 00 00");
  EXPECT_EQ(drive.ask("605 23 10 10 02 73 61 76 65"), "585 60 10 10 02 00 00 00 00");
  drive.ask("605 2B 17 10 00 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 20 10 01 00 00 00 00"), "585 43 20 10 01 00 00 00 00");
  drive.ask(bench::reset_communication);
  EXPECT_EQ(drive.ask("605 40 17 10 00 00 00 00 00"), "585 4B 17 10 00 00 08 00 00");
  EXPECT_EQ(drive.ask("605 40 20 10 01 00 00 00 00"), "585 43 20 10 01 34 3C 00 00");
}

// Manual 004, 4.2: 1011h, 6010h

TEST(StorageOfManual004, RestoresWithThePowerCycleAndLeavesTheCobIds) {
  MemoryStorage storage;
  {
    Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
    sensor.ask("605 23 05 10 00 81 00 00 00");
    sensor.ask("605 2B 17 10 00 00 08 00 00");
    sensor.ask("605 2B 00 62 00 0A 00 00 00");
    EXPECT_EQ(sensor.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
    EXPECT_EQ(sensor.ask("605 23 11 10 01 6C 6F 61 64"), "585 60 11 10 01 00 00 00 00");
    sensor.ask(bench::reset_node);
    EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 0A 00 00 00");
  }
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 01 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 00 00 00");
  EXPECT_EQ(sensor.ask("605 40 05 10 00 00 00 00 00"), "585 42 05 10 00 81 00 00 00");
}

TEST(StorageOfManual004, ANewNodeIdBringsTheDefaultCobIds) {
  MemoryStorage storage;
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  sensor.ask("605 23 05 10 00 81 00 00 00");
  sensor.ask("605 23 14 10 00 A0 00 00 00");
  sensor.ask("605 23 10 10 01 73 61 76 65");
  sensor.node.start(canopen::NodeId{9}, sensor.now);
  sensor.bus.take();
  EXPECT_EQ(sensor.ask("609 40 05 10 00 00 00 00 00"), "589 42 05 10 00 80 00 00 00");
  EXPECT_EQ(sensor.ask("609 40 14 10 00 00 00 00 00"), "589 42 14 10 00 89 00 00 00");
}

TEST(StorageOfManual004, DoesNotSaveThePreset) {
  MemoryStorage storage;
  {
    Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
    sensor.ask("605 23 10 60 01 E8 03 00 00");
    sensor.ask("605 23 10 10 01 73 61 76 65");
    EXPECT_EQ(sensor.ask("605 40 10 60 01 00 00 00 00"), "585 42 10 60 01 E8 03 00 00");
  }
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  EXPECT_EQ(sensor.ask("605 40 10 60 01 00 00 00 00"), "585 42 10 60 01 00 00 00 00");
}

}  // namespace
