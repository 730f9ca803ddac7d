/// Multiplex PDOs that a node consumes, frame by frame: destination and source addressing mode.
#include <gtest/gtest.h>

#include <mpdo_device/device.hpp>
#include <vector>

#include "mpdo_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::RpdoEvent;
using mpdo_bench::Bench;
using mpdo_bench::Running;
namespace od = mpdo_device::od;

// DAM consumer

TEST(DamConsumer, WritesTheObjectThatTheFrameNames) {
  Running device;
  device.ask("205 85 01 20 00 34 12 00 00");
  EXPECT_EQ(device.node.get<od::word>(), 0x1234);
  device.ask("205 85 02 20 03 FE FF FF FF");
  EXPECT_EQ(device.node.get<od::positions<3>>(), -2);
  device.ask("205 85 03 20 00 FD FF FF 00");
  EXPECT_EQ(device.node.get<od::signed_24_bits>(), -3);
  device.ask("205 85 08 20 00 01 00 00 00");
  EXPECT_TRUE(device.node.get<od::contact>());
}

TEST(DamConsumer, TakesFramesForAllNodes) {
  Running device;
  device.ask("205 80 00 20 00 5A 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x5A);
}

TEST(DamConsumer, LeavesFramesForOtherNodes) {
  Running device;
  EXPECT_EQ(device.ask("205 86 00 20 00 5A 00 00 00"), "");
  EXPECT_EQ(device.ask("205 86 99 99 00 5A 00 00 00"), "");  // an error of that node, if any
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(DamConsumer, LeavesFramesInSourceAddressingMode) {
  Running device;
  EXPECT_EQ(device.ask("205 05 00 20 00 5A 00 00 00"), "");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(DamConsumer, TakesNothingBeforeOperational) {
  Bench device;
  device.ask("205 85 00 20 00 5A 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(DamConsumer, TellsADestinationThatDoesNotExistOnce) {
  Running device;
  EXPECT_EQ(device.ask("205 85 00 30 00 01 00 00 00"), "085 30 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("205 85 00 30 00 01 00 00 00"), "");
  EXPECT_EQ(device.ask("205 85 00 20 01 01 00 00 00"), "");  // no such sub-index
  EXPECT_EQ(device.ask("205 85 00 20 00 01 00 00 00"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("205 80 00 30 00 01 00 00 00"), "085 30 82 11 00 00 00 00 00");
}

TEST(DamConsumer, TellsADestinationThatCannotBeMapped) {
  for (const char* frame : {
           "205 85 07 20 00 01 00 00 00",  // PDOMapping=0
           "205 85 04 20 00 01 00 00 00",  // ro
           "205 85 06 20 00 01 00 00 00",  // 64 bits
           "205 85 17 10 00 01 00 00 00",  // of the communication profile
       }) {
    Running device;
    EXPECT_EQ(device.ask(frame), "085 30 82 11 00 00 00 00 00") << frame;
  }
}

TEST(DamConsumer, ForgetsItsErrorWhenOperationalIsEnteredAnew) {
  Running device;
  device.ask("205 85 00 30 00 01 00 00 00");
  device.ask(bench::enter_pre_operational);
  EXPECT_EQ(device.ask(bench::start), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("205 85 00 30 00 01 00 00 00"), "085 30 82 11 00 00 00 00 00");
}

TEST(DamConsumer, TellsAShortFrameOnce) {
  Running device;
  EXPECT_EQ(device.ask("205 85 00 20 00 5A"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("205 85 00 20 00 5A 00 00"), "");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
  EXPECT_EQ(device.ask("205 85 00 20 00 5A 00 00 00"), "085 00 00 00 00 00 00 00 00");
}

TEST(DamConsumer, KeepsTheLimitsOfAnObject) {
  Running device;
  EXPECT_EQ(device.ask("205 85 05 20 00 65 00 00 00"), "");
  EXPECT_EQ(device.node.get<od::percentage>(), 0);
  device.ask("205 85 05 20 00 64 00 00 00");
  EXPECT_EQ(device.node.get<od::percentage>(), 100);
}

TEST(DamConsumer, AsksTheHandlers) {
  std::vector<int> values;
  std::vector<int> events;
  auto device = bench::with<mpdo_device::Device>(canopen::on_write<od::byte>([&](std::uint8_t value) {
                                                   values.push_back(value);
                                                   return value == 7 ? canopen::AbortCode::invalid_value : canopen::ok;
                                                 }),
                                                 canopen::on_rpdo([&](RpdoEvent event, std::uint16_t number) {
                                                   EXPECT_EQ(event, RpdoEvent::taken);
                                                   events.push_back(number);
                                                 }));
  device.ask(bench::start);
  device.ask("205 85 00 20 00 06 00 00 00");
  device.ask("205 85 00 20 00 07 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 6);
  EXPECT_EQ(values, (std::vector<int>{6, 7}));
  EXPECT_EQ(events, (std::vector<int>{1, 1}));
}

// SAM consumer. 1FD0h: 2004h:00 of node 7 goes to 2001h:00, 3000h:04..06 of node 7 go to 2002h:01..03. 1FD1h: 2005h:00
// of node 7 goes to 2000h:00.

TEST(SamConsumer, WritesTheObjectThatTheDispatchingListNames) {
  Running device;
  EXPECT_EQ(device.ask("305 07 05 20 00 5A 00 00 00"), "");
  EXPECT_EQ(device.node.get<od::byte>(), 0x5A);
}

TEST(SamConsumer, DispatchesBlocks) {
  Running device;
  device.ask("305 07 00 30 06 FE FF FF FF");
  EXPECT_EQ(device.node.get<od::positions<3>>(), -2);
  device.ask("305 07 00 30 07 FF FF FF FF");
  device.ask("305 07 00 30 03 FF FF FF FF");
  EXPECT_EQ(device.node.get<od::positions<1>>(), 0);
}

TEST(SamConsumer, LeavesWhatTheListDoesNotName) {
  Running device;
  EXPECT_EQ(device.ask("305 06 05 20 00 5A 00 00 00"), "");  // another node
  EXPECT_EQ(device.ask("305 07 06 20 00 5A 00 00 00"), "");  // another object
  EXPECT_EQ(device.ask("305 07 05 20 01 5A 00 00 00"), "");  // another sub-index
  EXPECT_EQ(device.ask("305 87 05 20 00 5A 00 00 00"), "");  // destination addressing mode
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(SamConsumer, FollowsAListThatIsWritten) {
  Running device;
  // 2000h:00 from 4000h:01 of node 9, as two segments of eight bytes.
  EXPECT_EQ(device.ask("605 21 D0 1F 03 08 00 00 00"), "585 60 D0 1F 03 00 00 00 00");
  EXPECT_EQ(device.ask("605 00 09 01 00 40 00 00 20"), "585 20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 1D 01 00 00 00 00 00 00"), "585 30 00 00 00 00 00 00 00");
  device.ask("305 09 00 40 01 77 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x77);
}

}  // namespace
