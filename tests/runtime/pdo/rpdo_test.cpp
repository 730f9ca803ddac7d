#include <gtest/gtest.h>

#include <vector>

#include "support/bench.hpp"

namespace {

using bench::Bench;
namespace od = sample::od;
using namespace std::chrono_literals;

TEST(Rpdo, IsTakenOverAtOnceInOperational) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0x000F);
  EXPECT_EQ(device.node.get<od::modes_of_operation>(), 3);
  EXPECT_EQ(device.node.get<od::target_position>(), 1000);
}

TEST(Rpdo, IsIgnoredOutsideOperational) {
  Bench device;
  device.ask("205 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0);
  device.ask(bench::stop);
  device.ask("205 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0);
}

TEST(Rpdo, OneShorterThanTheMappingIsNotTaken) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 0F 00 03 E8 03 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0);
}

TEST(Rpdo, OfALongerOneTheFirstBytesCount) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 0F 00 03 E8 03 00 00 99");
  EXPECT_EQ(device.node.get<od::target_position>(), 1000);
}

TEST(Rpdo, RemoteAndExtendedFramesAreNotMeant) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 R 7");
  device.ask("00000205 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0);
}

TEST(Rpdo, UnpacksObjectsAtAnyBitAndSkipsDummies) {
  Bench device;
  device.ask(bench::start);
  device.ask("305 FE FB 56 34 02");  // 0, 1, dummy FFh, 8D15BEh
  EXPECT_FALSE(device.node.get<od::outputs::output_1>());
  EXPECT_TRUE(device.node.get<od::outputs::output_2>());
  EXPECT_EQ(device.node.get<od::unsigned24_value>(), 0x8D15BEu);
}

TEST(Rpdo, NegativeValuesKeepTheirSign) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 00 00 FF 18 FC FF FF");
  EXPECT_EQ(device.node.get<od::modes_of_operation>(), -1);
  EXPECT_EQ(device.node.get<od::target_position>(), -1000);
}

TEST(Rpdo, ValuesOutsideTheirLimitsAreNotTakenTheOthersAre) {
  Bench device;
  device.ask(bench::start);
  device.ask("205 0F 00 0B E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0x000F);
  EXPECT_EQ(device.node.get<od::modes_of_operation>(), 0);
  EXPECT_EQ(device.node.get<od::target_position>(), 1000);
}

TEST(Rpdo, CallsTheWriteHandlersAndHeedsTheirAnswer) {
  std::vector<int> commands;
  auto device = bench::with(canopen::on_write<od::controlword>([&](std::uint16_t command) {
    commands.push_back(command);
    return command <= 0x0F ? canopen::ok : canopen::AbortCode::value_too_high;
  }));
  device.ask(bench::start);
  device.ask("205 0F 00 01 00 00 00 00");
  device.ask("205 10 00 02 00 00 00 00");
  EXPECT_EQ(commands, (std::vector{0x0F, 0x10}));
  EXPECT_EQ(device.node.get<od::controlword>(), 0x0F);
  EXPECT_EQ(device.node.get<od::modes_of_operation>(), 2);
}

TEST(Rpdo, AHandlerMayAnswerThroughTheNode) {
  auto device = bench::with(canopen::on_write<od::controlword>(
      [](auto& node, std::uint16_t command) { node.template set<od::statusword>(command); }));
  device.ask(bench::start);
  EXPECT_EQ(device.ask("205 0F 00 01 00 00 00 00"), "185 0F 00 00 00 00 00");
}

TEST(Rpdo, TakesANewCobIdAtOnce) {
  Bench device;
  device.ask(bench::start);
  device.ask("605 23 00 14 01 05 02 00 80");
  device.ask("205 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0);
  device.ask("605 23 00 14 01 22 02 00 00");
  device.ask("222 0F 00 03 E8 03 00 00");
  EXPECT_EQ(device.node.get<od::controlword>(), 0x0F);
}

TEST(Rpdo, TransmissionTypesThatOnlyATpdoHasAreRefused) {
  Bench device;
  for (const std::string type : {"F1", "FC", "FD"}) {
    EXPECT_EQ(device.ask("605 2F 00 14 02 " + type + " 00 00 00"), "585 80 00 14 02 30 00 09 06") << type;
  }
  EXPECT_EQ(device.ask("605 2F 00 14 02 FE 00 00 00"), "585 60 00 14 02 00 00 00 00");
}

}  // namespace
