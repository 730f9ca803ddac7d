/// Fastscan of an LSS slave.
#include <gtest/gtest.h>

#include <canopen/lss/lss_slave.hpp>

#include "lss_bench.hpp"

namespace {

using bench::LssDevice;
using canopen::LssOptions;
using canopen::LssState;
using canopen::unconfigured_node_id;

constexpr auto identify_non_configured = "7E5 4C 00 00 00 00 00 00 00";
constexpr auto fastscan_reset = "7E5 51 00 00 00 00 80 00 00";
constexpr auto identified = "7E4 4F 00 00 00 00 00 00 00";

TEST(LssFastscan, AsksForTheBitsFromBitCheckOn) {
  LssDevice device{unconfigured_node_id};
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 00 00 00 00 1F 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 00 00 00 80 1F 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 80 00 00 00 07 00 00"), identified);  // 93h = 1001 0011
  EXPECT_EQ(device.ask("7E5 51 80 00 00 00 04 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 90 00 00 00 04 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 9F 00 00 00 04 00 00"), identified);
  EXPECT_EQ(device.ask("7E5 51 92 00 00 00 00 00 00"), "");
}

TEST(LssFastscan, GoesOnToTheNextNumberAndEndsInConfigurationState) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), "");
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), identified);
  EXPECT_EQ(device.ask("7E5 51 01 00 01 00 00 02 03"), identified);
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask("7E5 51 34 12 01 15 00 03 00"), identified);
  EXPECT_EQ(device.slave.state(), LssState::configuration);
  EXPECT_EQ(device.ask(fastscan_reset), "");
}

TEST(LssFastscan, StaysWithANumberWhoseLastBitIsAskedFor) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 00"), identified);
  EXPECT_EQ(device.slave.state(), LssState::waiting);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, BeginsAgainWithTheVendorIdAfterResetCommunication) {
  LssDevice device{unconfigured_node_id};
  device.ask("7E5 51 93 00 00 00 00 00 01");
  device.reset_communication();
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, TakesNoPartAnyMoreWhenANumberIsAnotherOne) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 92 00 00 00 00 00 01"), "");
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), "");
  EXPECT_EQ(device.ask("7E5 51 00 00 00 00 1F 01 01"), "");
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, BeginsAgainWithTheVendorIdAfterAReset) {
  LssDevice device{unconfigured_node_id};
  device.ask("7E5 51 93 00 00 00 00 00 01");
  EXPECT_EQ(device.ask(fastscan_reset), identified);
  EXPECT_EQ(device.ask("7E5 51 52 4B 35 43 00 01 02"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, IgnoresBitsAndNumbersThatDoNotExist) {
  LssDevice device{unconfigured_node_id};
  device.ask(fastscan_reset);
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 20 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 7F 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 81 00 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 04 00"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 04"), "");
  EXPECT_EQ(device.ask("7E5 51 93 00 00 00 00 00 01"), identified);
}

TEST(LssFastscan, IsNotServedWhereTheDeviceHasItNot) {
  LssDevice<LssOptions{.fastscan = false}> device{unconfigured_node_id};
  EXPECT_EQ(device.ask(fastscan_reset), "");
  EXPECT_EQ(device.ask(identify_non_configured), "7E4 50 00 00 00 00 00 00 00");
}

}  // namespace
