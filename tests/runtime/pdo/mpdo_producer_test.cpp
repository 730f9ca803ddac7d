/// Multiplex PDOs that a node produces, frame by frame: destination and source addressing mode.
#include <gtest/gtest.h>

#include <mpdo_device/device.hpp>

#include "mpdo_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::MpdoDestination;
using canopen::NodeId;
using mpdo_bench::Bench;
using mpdo_bench::Running;
namespace od = mpdo_device::od;
using namespace std::chrono_literals;

// SAM producer. 1FA0h: 2001h:00 and 2002h:01..03. 1FA1h: 2004h:00 and 2003h:00.

TEST(SamProducer, SendsAnObjectThatHasANewValue) {
  Running device;
  device.node.set<od::word>(0x1234);
  EXPECT_EQ(device.node.next_deadline(), device.now);
  EXPECT_EQ(device.pass(0s), "185 05 01 20 00 34 12 00 00");
  device.node.set<od::word>(0x1234);
  EXPECT_EQ(device.pass(0s), "");
  EXPECT_EQ(device.node.set<od::signed_24_bits>(-2), canopen::ok);
  EXPECT_EQ(device.pass(0s), "185 05 03 20 00 FE FF FF 00");
}

TEST(SamProducer, SendsWhatSdoWrites) {
  Running device;
  EXPECT_EQ(device.ask("605 2B 01 20 00 34 12 00 00"), "585 60 01 20 00 00 00 00 00 | 185 05 01 20 00 34 12 00 00");
}

TEST(SamProducer, SendsWhatAnMpdoBrings) {
  Running device;
  EXPECT_EQ(device.ask("205 85 01 20 00 34 12 00 00"), "185 05 01 20 00 34 12 00 00");
}

TEST(SamProducer, SendsWhatAnRpdoOfDynamicMappingBrings) {
  Running device;
  device.ask("605 23 02 16 01 10 00 01 20");
  device.ask("605 2F 02 16 00 01 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  EXPECT_EQ(device.ask("222 34 12"), "185 05 01 20 00 34 12 00 00");
}

TEST(SamProducer, SendsSeveralObjectsOneAfterTheOther) {
  Running device;
  device.node.set<od::input>(7);
  device.node.set<od::positions<3>>(3);
  device.node.set<od::positions<1>>(1);
  device.node.set<od::positions<1>>(2);
  EXPECT_EQ(device.pass(0s), "185 05 02 20 01 02 00 00 00 | 185 05 02 20 03 03 00 00 00 | 185 05 04 20 00 07 00 00 00");
}

TEST(SamProducer, LeavesWhatTheListDoesNotName) {
  Running device;
  device.node.set<od::byte>(1);
  EXPECT_EQ(device.pass(1s), "");
}

TEST(SamProducer, SendsNothingBeforeOperational) {
  Bench device;
  device.node.set<od::word>(1);
  EXPECT_EQ(device.ask(bench::start), "");
  EXPECT_EQ(device.pass(1s), "");
}

TEST(SamProducer, KeepsTheInhibitTimeAndGivesEachObjectItsTurn) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 2B 00 18 03 64 00 00 00");  // 10 ms
  device.ask("605 23 00 18 01 85 01 00 00");
  device.ask(bench::start);
  device.node.set<od::word>(1);
  device.node.set<od::input>(1);
  EXPECT_EQ(device.pass(9999us), "185 05 01 20 00 01 00 00 00");
  device.node.set<od::word>(2);
  EXPECT_EQ(device.pass(1us), "185 05 04 20 00 01 00 00 00");
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), "185 05 01 20 00 02 00 00 00");
}

TEST(SamProducer, WaitsForRoomOnTheBus) {
  Running device;
  device.bus.room = 0;
  device.node.set<od::word>(1);
  EXPECT_EQ(device.pass(0s), "");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s), "185 05 01 20 00 01 00 00 00");
}

TEST(SamProducer, FollowsAListThatIsWritten) {
  Running device;
  EXPECT_EQ(device.ask("605 23 A0 1F 03 00 00 20 01"), "585 60 A0 1F 03 00 00 00 00");
  device.node.set<od::byte>(0x5A);
  EXPECT_EQ(device.pass(0s), "185 05 00 20 00 5A 00 00 00");
  device.ask("605 23 A0 1F 03 00 00 00 00");
  device.node.set<od::byte>(0);
  EXPECT_EQ(device.pass(0s), "");
}

TEST(SamProducer, ForgetsWhatIsPendingWhenTheListChanges) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 2B 00 18 03 64 00 00 00");  // 10 ms
  device.ask("605 23 00 18 01 85 01 00 00");
  device.ask(bench::start);
  device.node.set<od::word>(1);
  device.node.set<od::positions<3>>(3);
  EXPECT_EQ(device.pass(0s), "185 05 01 20 00 01 00 00 00");
  EXPECT_EQ(device.ask("605 23 A0 1F 02 01 02 20 01"), "585 60 A0 1F 02 00 00 00 00");  // 2002h:01 only
  EXPECT_EQ(device.ask("605 23 A0 1F 03 00 00 20 01"), "585 60 A0 1F 03 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 A0 1F 04 00 04 20 01"), "585 60 A0 1F 04 00 00 00 00");  // in the place of 2002h:03
  EXPECT_EQ(device.pass(1s), "");
}

TEST(SamProducer, SendsFramesOf29Bits) {
  Running device;
  device.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(device.ask("605 23 00 18 01 85 01 00 20"), "585 60 00 18 01 00 00 00 00");
  device.node.set<od::word>(1);
  EXPECT_EQ(device.pass(0s), "00000185 05 01 20 00 01 00 00 00");
}

TEST(SamProducer, RefusesElementsThatItCannotSend) {
  Running device;
  const std::string not_mappable = "585 80 A0 1F 03 41 00 04 06";
  EXPECT_EQ(device.ask("605 23 A0 1F 03 00 00 30 01"), not_mappable);  // no such object
  EXPECT_EQ(device.ask("605 23 A0 1F 03 00 07 20 01"), not_mappable);  // PDOMapping=0
  EXPECT_EQ(device.ask("605 23 A0 1F 03 00 06 20 01"), not_mappable);  // 64 bits
  EXPECT_EQ(device.ask("605 23 A0 1F 03 01 02 20 04"), not_mappable);  // longer than the array
}

TEST(SamProducer, RefusesAListLongerThanTheObjectsThatThereAre) {
  Running device;
  EXPECT_EQ(device.ask("605 23 A0 1F 03 01 02 20 03"), "585 60 A0 1F 03 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 A0 1F 04 01 02 20 03"), "585 80 A0 1F 04 42 00 04 06");
}

TEST(SamProducer, IsOffWhileItsTpdoIsNotValid) {
  Running device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.node.set<od::word>(1);
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_FALSE(device.node.next_deadline());
}

// DAM producer

TEST(DamProducer, SendsTheValueOfAnObject) {
  Running device;
  EXPECT_EQ(device.node.set<od::percentage>(42), canopen::ok);
  EXPECT_TRUE(device.node.send_mpdo<od::percentage>({NodeId{6}, 0x2000, 0}));
  EXPECT_EQ(device.node.next_deadline(), device.now);
  EXPECT_EQ(device.pass(0s), "285 86 00 20 00 2A 00 00 00");
}

TEST(DamProducer, SendsNegativeValuesInTheirOwnLength) {
  Running device;
  EXPECT_EQ(device.node.set<od::signed_24_bits>(-2), canopen::ok);
  device.pass(0s);
  EXPECT_TRUE(device.node.send_mpdo<od::signed_24_bits>({NodeId{6}, 0x3000, 1}));
  EXPECT_EQ(device.pass(0s), "285 86 00 30 01 FE FF FF 00");
}

TEST(DamProducer, SendsAValueToAllNodes) {
  Running device;
  EXPECT_TRUE(device.node.send_mpdo({canopen::all_nodes, 0x6041, 2}, 0x12345678));
  EXPECT_EQ(device.pass(0s), "285 80 41 60 02 78 56 34 12");
}

TEST(DamProducer, KeepsTheInhibitTime) {
  Bench device;
  device.ask("605 23 01 18 01 85 02 00 80");
  device.ask("605 2B 01 18 03 64 00 00 00");  // 10 ms
  device.ask("605 23 01 18 01 85 02 00 00");
  device.ask(bench::start);
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 1));
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 2));
  EXPECT_EQ(device.pass(9999us), "285 86 00 20 00 01 00 00 00");
  EXPECT_EQ(device.pass(1us), "285 86 00 20 00 02 00 00 00");
}

TEST(DamProducer, SendsAtOnceHoweverLongAgoTheInhibitTimeEnded) {
  Bench device;
  device.ask("605 23 01 18 01 85 02 00 80");
  device.ask("605 2B 01 18 03 64 00 00 00");
  device.ask("605 23 01 18 01 85 02 00 00");
  device.ask(bench::start);
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 1));
  EXPECT_EQ(device.pass(0s), "285 86 00 20 00 01 00 00 00");
  for (int i = 0; i < 4; ++i) device.pass(10min);
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 2));
  EXPECT_EQ(device.pass(0s), "285 86 00 20 00 02 00 00 00");
}

TEST(DamProducer, RefusesWhatItCannotSend) {
  Bench device;
  const MpdoDestination to{NodeId{6}, 0x2000, 0};
  EXPECT_FALSE(device.node.send_mpdo(to, 1));  // Pre-operational
  device.ask(bench::start);
  device.bus.room = 0;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(device.node.send_mpdo(to, 1));
  EXPECT_FALSE(device.node.send_mpdo(to, 1));  // four are waiting
  device.bus.room = 100;
  device.pass(0s);
  device.ask("605 23 01 18 01 85 02 00 80");
  EXPECT_FALSE(device.node.send_mpdo(to, 1));  // no valid DAM-TPDO
  EXPECT_EQ(device.pass(1s), "");
}

TEST(SamProducer, ForgetsWhatWaitsWhenItsTpdoIsMadeInvalid) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 2B 00 18 03 64 00 00 00");  // 10 ms
  device.ask("605 23 00 18 01 85 01 00 00");
  device.ask(bench::start);
  device.node.set<od::word>(1);
  EXPECT_NE(device.pass(0s), "");
  device.node.set<od::word>(2);
  device.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(device.pass(1s), "");
  device.ask("605 23 00 18 01 85 01 00 00");
  EXPECT_EQ(device.pass(1s), "");
}

}  // namespace
