/// 1020h, verify configuration.
#include <gtest/gtest.h>

#include <array>
#include <canopen/host/memory_storage.hpp>
#include <stored_device/device.hpp>

#include "parameter_storage_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::MemoryStorage;
using storage_bench::powered;
using storage_bench::save_all;
namespace od = stored_device::od;

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

}  // namespace
