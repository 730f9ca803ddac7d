/// Store and restore as described in the manuals of the reference devices.
#include <gtest/gtest.h>

#include <can_2057c/device.hpp>
#include <canopen/host/memory_storage.hpp>
#include <cpc_tc1/device.hpp>
#include <cpd/device.hpp>
#include <rk5c/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;

template <class Device, class... Handlers>
using Powered = bench::Bench<Device, canopen::StoredIn<MemoryStorage>, Handlers...>;

// Manual 000, chapter 12, 1010h and 1011h

// shows 000.158, 000.159
TEST(StorageOfManual000, TakesTheSignaturesForEachRange) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  for (unsigned sub_index = 1; sub_index <= 4; ++sub_index) {
    const std::string range = " 0" + std::to_string(sub_index);
    const int commits = storage.commits;
    EXPECT_EQ(drive.ask("605 23 10 10" + range + " 73 61 76 65"), "585 60 10 10" + range + " 00 00 00 00");
    EXPECT_EQ(storage.commits, commits + 1);
    EXPECT_EQ(drive.ask("605 23 11 10" + range + " 6C 6F 61 64"), "585 60 11 10" + range + " 00 00 00 00");
    EXPECT_EQ(drive.ask("605 23 11 10" + range + " 64 61 6F 6C"), "585 80 11 10" + range + " 22 00 00 08");
  }
}

// shows 000.140
TEST(StorageOfManual000, RestoresWithAReset) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  drive.ask("605 2B 15 10 00 64 00 00 00");
  drive.ask("605 23 10 10 01 73 61 76 65");
  EXPECT_EQ(drive.ask("605 23 11 10 01 6C 6F 61 64"), "585 60 11 10 01 00 00 00 00");
  EXPECT_EQ(drive.ask("605 40 15 10 00 00 00 00 00"), "585 4B 15 10 00 64 00 00 00");
  drive.ask(bench::reset_node);
  EXPECT_EQ(drive.ask("605 40 15 10 00 00 00 00 00"), "585 4B 15 10 00 00 00 00 00");
}

// shows 000.143
TEST(StorageOfManual000, SavesNothingByItself) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  drive.ask("605 2B 15 10 00 64 00 00 00");
  drive.ask(bench::start);
  drive.pass(std::chrono::seconds{10});
  drive.ask(bench::reset_node);
  EXPECT_EQ(storage.commits, 0);
  EXPECT_EQ(drive.ask("605 40 15 10 00 00 00 00 00"), "585 4B 15 10 00 00 00 00 00");
}

// shows 000.138, 000.139
TEST(StorageOfManual000, RefusesAWrongSignatureByTheDeviceState) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  EXPECT_EQ(drive.ask("605 40 10 10 02 00 00 00 00"), "585 43 10 10 02 01 00 00 00");
  EXPECT_EQ(drive.ask("605 23 10 10 02 64 61 6F 6C"), "585 80 10 10 02 22 00 00 08");
  EXPECT_EQ(drive.ask("605 23 11 10 02 73 61 76 65"), "585 80 11 10 02 22 00 00 08");
  EXPECT_EQ(drive.ask("605 23 10 10 02 73 61 76 65"), "585 60 10 10 02 00 00 00 00");
  EXPECT_EQ(drive.ask("605 23 11 10 02 6C 6F 61 64"), "585 60 11 10 02 00 00 00 00");
}

// shows 000.138, 000.139
TEST(StorageOfManual000, TellsThatStoringFailed) {
  MemoryStorage storage;
  Powered<cpc_tc1::Device> drive{canopen::stored_in(storage)};
  drive.ask("605 23 10 10 01 73 61 76 65");
  storage.fails_to_commit = true;
  EXPECT_EQ(drive.ask("605 23 10 10 01 73 61 76 65"), "585 80 10 10 01 00 00 06 06");
  EXPECT_EQ(drive.ask("605 23 11 10 01 6C 6F 61 64"), "585 80 11 10 01 00 00 06 06");
}

TEST(StorageOfManual000, LeavesTheVirtualMachineToTheApplication) {
  MemoryStorage storage;
  bool program_stored = false;
  auto store = canopen::on_write<cpc_tc1::od::store_parameters<5>>(
      [&](cpc_tc1::od::store_parameters<5>::type) { program_stored = true; });
  Powered<cpc_tc1::Device, decltype(store)> drive{canopen::stored_in(storage), store};
  EXPECT_EQ(drive.ask("605 23 10 10 05 73 61 76 65"), "585 60 10 10 05 00 00 00 00");
  EXPECT_TRUE(program_stored);
}

// Manual 002, 9.4.10, 9.4.11, 9.4.17, 3.6.1

// shows 002.46, 002.66, 002.67, 002.117, 002.192
TEST(StorageOfManual002, EachCommandSavesAndRestoresItsRange) {
  struct Row {
    const char* sub_index;
    bool communication, application;
  };
  constexpr Row rows[] = {{"01", true, true}, {"02", true, false}, {"03", false, true}};
  for (const auto& [sub_index, communication, application] : rows) {
    const std::string save = std::string{"605 23 10 10 "} + sub_index + " 73 61 76 65";
    const std::string load = std::string{"605 23 11 10 "} + sub_index + " 6C 6F 61 64";
    MemoryStorage storage;
    const auto time = [&](auto& drive) { return drive.ask("605 40 17 10 00 00 00 00 00"); };
    const auto velocity = [&](auto& drive) { return drive.ask("605 40 7F 60 00 00 00 00 00"); };
    const auto write = [](auto& drive) {
      drive.ask("605 2B 17 10 00 00 08 00 00");
      drive.ask("605 23 7F 60 00 2A 00 00 00");
    };
    constexpr auto changed_time = "585 4B 17 10 00 00 08 00 00";
    constexpr auto changed_velocity = "585 43 7F 60 00 2A 00 00 00";
    {
      Powered<cpd::Device> drive{canopen::stored_in(storage)};
      EXPECT_EQ(drive.ask("605 40 10 10 00 00 00 00 00"), "585 4F 10 10 00 03 00 00 00");
      EXPECT_EQ(drive.ask("605 40 11 10 00 00 00 00 00"), "585 4F 11 10 00 03 00 00 00");
      write(drive);
    }
    {
      Powered<cpd::Device> drive{canopen::stored_in(storage)};
      EXPECT_NE(time(drive), changed_time);
      EXPECT_NE(velocity(drive), changed_velocity);
      write(drive);
      EXPECT_EQ(drive.ask(save).substr(0, 6), "585 60");
    }
    {
      Powered<cpd::Device> drive{canopen::stored_in(storage)};
      EXPECT_EQ(time(drive) == changed_time, communication) << sub_index;
      EXPECT_EQ(velocity(drive) == changed_velocity, application) << sub_index;
      write(drive);
      drive.ask("605 23 10 10 01 73 61 76 65");
      EXPECT_EQ(drive.ask(load).substr(0, 6), "585 60");
    }
    Powered<cpd::Device> drive{canopen::stored_in(storage)};
    EXPECT_EQ(time(drive) != changed_time, communication) << sub_index;
    EXPECT_EQ(velocity(drive) != changed_velocity, application) << sub_index;
  }
}

// shows 002.49, 002.50
TEST(StorageOfManual002, ResetNodeLoadsBothPartsAndResetCommunicationItsOwn) {
  MemoryStorage storage;
  Powered<cpd::Device> drive{canopen::stored_in(storage)};
  drive.ask("605 2B 15 10 00 64 00 00 00");
  drive.ask("605 23 7F 60 00 2A 00 00 00");
  drive.ask("605 23 10 10 01 73 61 76 65");
  drive.ask("605 2B 15 10 00 00 00 00 00");
  drive.ask("605 23 7F 60 00 2B 00 00 00");
  EXPECT_EQ(drive.ask(bench::reset_communication), "705 00");
  EXPECT_EQ(drive.ask("605 40 15 10 00 00 00 00 00"), "585 4B 15 10 00 64 00 00 00");
  EXPECT_EQ(drive.ask("605 40 7F 60 00 00 00 00 00"), "585 43 7F 60 00 2B 00 00 00");
  EXPECT_EQ(drive.ask(bench::reset_node), "705 00");
  EXPECT_EQ(drive.ask("605 40 7F 60 00 00 00 00 00"), "585 43 7F 60 00 2A 00 00 00");
  EXPECT_EQ(drive.node.state(), canopen::NmtState::pre_operational);
}

// shows 002.50
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

// Manual 003, 6.1 note 6

// shows 003.94
TEST(StorageOfManual003, StoresAndRestoresTheModule) {
  MemoryStorage storage;
  {
    Powered<can_2057c::Device> module{canopen::stored_in(storage)};
    module.ask("605 2B 0C 10 00 FA 00 00 00");
    module.ask("605 2F 06 62 01 0F 00 00 00");
    EXPECT_EQ(module.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
  }
  {
    Powered<can_2057c::Device> module{canopen::stored_in(storage)};
    EXPECT_EQ(module.ask("605 40 0C 10 00 00 00 00 00"), "585 4B 0C 10 00 FA 00 00 00");
    EXPECT_EQ(module.ask("605 40 06 62 01 00 00 00 00"), "585 4F 06 62 01 0F 00 00 00");
    EXPECT_EQ(module.ask("605 23 11 10 01 6C 6F 61 64"), "585 60 11 10 01 00 00 00 00");
  }
  Powered<can_2057c::Device> module{canopen::stored_in(storage)};
  EXPECT_EQ(module.ask("605 40 0C 10 00 00 00 00 00"), "585 4B 0C 10 00 00 00 00 00");
  EXPECT_EQ(module.ask("605 40 06 62 01 00 00 00 00"), "585 4F 06 62 01 FF 00 00 00");
}

// Manual 004, 4.2: 1011h, 6010h

// shows 004.68, 004.69
TEST(StorageOfManual004, StoresAllParametersWithSaveOnly) {
  MemoryStorage storage;
  {
    Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
    EXPECT_EQ(sensor.ask("605 40 10 10 01 00 00 00 00"), "585 42 10 10 01 01 00 00 00");
    EXPECT_EQ(sensor.ask("605 40 11 10 01 00 00 00 00"), "585 42 11 10 01 01 00 00 00");
    sensor.ask("605 2B 17 10 00 00 08 00 00");
    sensor.ask("605 2B 00 62 00 0A 00 00 00");
    EXPECT_EQ(sensor.ask("605 23 10 10 01 65 76 61 73"), "585 80 10 10 01 20 00 00 08");
    EXPECT_EQ(storage.commits, 0);
    EXPECT_EQ(sensor.ask("605 23 10 10 01 73 61 76 65"), "585 60 10 10 01 00 00 00 00");
    EXPECT_EQ(sensor.ask("605 23 11 10 01 64 61 6F 6C"), "585 80 11 10 01 20 00 00 08");
  }
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  EXPECT_EQ(sensor.ask("605 40 17 10 00 00 00 00 00"), "585 42 17 10 00 00 08 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 0A 00 00 00");
}

// shows 004.74
TEST(StorageOfManual004, AResetLosesWhatIsNotSaved) {
  MemoryStorage storage;
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  sensor.ask("605 2B 00 62 00 0A 00 00 00");
  sensor.ask("605 23 10 10 01 73 61 76 65");
  sensor.ask("605 2B 00 62 00 0B 00 00 00");
  EXPECT_EQ(sensor.ask(bench::reset_node), "705 00");
  EXPECT_EQ(sensor.ask("605 40 00 62 00 00 00 00 00"), "585 42 00 62 00 0A 00 00 00");
}

// shows 004.71, 004.73, 004.132
TEST(StorageOfManual004, LoadRestoresAllButTheCobIds) {
  struct Row {
    const char *write, *read, *changed, *restored;
  };
  constexpr Row rows[] = {
      {"23 05 10 00 A0 00 00 00", "40 05 10 00", "42 05 10 00 A0 00 00 00", "42 05 10 00 A0 00 00 00"},
      {"23 14 10 00 90 06 00 80", "40 14 10 00", "42 14 10 00 90 06 00 80", "42 14 10 00 90 06 00 80"},
      {"23 00 18 01 33 03 00 80", "40 00 18 01", "42 00 18 01 33 03 00 80", "42 00 18 01 33 03 00 80"},
      {"2B 15 10 00 64 00 00 00", "40 15 10 00", "42 15 10 00 64 00 00 00", "42 15 10 00 00 00 00 00"},
      {"2B 17 10 00 00 08 00 00", "40 17 10 00", "42 17 10 00 00 08 00 00", "42 17 10 00 00 00 00 00"},
      {"2F 00 18 02 01 00 00 00", "40 00 18 02", "42 00 18 02 01 00 00 00", "42 00 18 02 FE 00 00 00"},
      {"2B 00 18 05 64 00 00 00", "40 00 18 05", "42 00 18 05 64 00 00 00", "42 00 18 05 01 00 00 00"},
      {"2B 00 62 00 0A 00 00 00", "40 00 62 00", "42 00 62 00 0A 00 00 00", "42 00 62 00 01 00 00 00"},
  };
  const auto read = [](auto& sensor, const Row& row) {
    return sensor.ask(std::string{"605 "} + row.read + " 00 00 00 00").substr(4);
  };
  MemoryStorage storage;
  {
    Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
    for (const Row& row : rows) sensor.ask(std::string{"605 "} + row.write);
    sensor.ask("605 23 10 10 01 73 61 76 65");
  }
  {
    Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
    for (const Row& row : rows) EXPECT_EQ(read(sensor, row), row.changed);
    sensor.ask("605 23 11 10 01 6C 6F 61 64");
  }
  Powered<rk5c::Device> sensor{canopen::stored_in(storage)};
  for (const Row& row : rows) EXPECT_EQ(read(sensor, row), row.restored);
  EXPECT_EQ(sensor.ask("605 40 00 12 01 00 00 00 00"), "585 42 00 12 01 05 06 00 00");
  EXPECT_EQ(sensor.ask("605 40 00 12 02 00 00 00 00"), "585 42 00 12 02 85 05 00 00");
}

// shows 004.70
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
