/// When TPDOs are sent: transmission types, SYNC, remote frames.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>

#include "pdo_transmission_bench.hpp"
#include "support/bench.hpp"

namespace {

using transmission_bench::Bench;
using transmission_bench::Running;
using transmission_bench::sync;
namespace od = pdo_device::od;
using namespace std::chrono_literals;

// Synchronous TPDOs: TPDO1 is event-driven, TPDO2 has type 0, TPDO3 has type 1.

TEST(TpdoType0, IsSentAtTheSyncAfterAChange) {
  Running device;
  device.node.set<od::byte>(0x5A);
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_EQ(device.ask(sync), "285 5A | 385 00 00");
  EXPECT_EQ(device.ask(sync), "385 00 00");
}

TEST(TpdoType0, IsSentAtTheFirstSyncInOperational) {
  Bench device;
  EXPECT_EQ(device.ask(bench::start), "185 00 00 00 00 00 00");
  EXPECT_EQ(device.ask(sync), "285 00 | 385 00 00");
  EXPECT_EQ(device.ask(sync), "385 00 00");
}

TEST(TpdoType1, IsSentAtEverySync) {
  Running device;
  EXPECT_EQ(device.ask(sync), "385 00 00");
  device.node.set<od::input_word>(0x1234);
  device.pass(0s);  // TPDO1
  EXPECT_EQ(device.ask(sync), "385 34 12");
}

/// Frames with such a CAN-ID are for other nodes, unless a COB-ID of this one has it.
TEST(TpdoType1, IsSentAtASyncWithTheCanIdOfAPdo) {
  Running device;
  EXPECT_EQ(device.ask("605 23 05 10 00 90 01 00 00"), "585 60 05 10 00 00 00 00 00");
  EXPECT_EQ(device.ask("190"), "385 00 00");
  EXPECT_EQ(device.ask("191"), "");
  EXPECT_EQ(device.ask(sync), "");
}

TEST(TpdoType3, IsSentAtEveryThirdSync) {
  Running device;
  device.ask("605 2F 02 18 02 03 00 00 00");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask(sync), "385 00 00");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask(sync), "385 00 00");
}

TEST(TpdoType240, IsSentAtEvery240thSync) {
  Running device;
  device.ask("605 2F 02 18 02 F0 00 00 00");
  for (int i = 1; i < 240; ++i) EXPECT_EQ(device.ask(sync), "") << i;
  EXPECT_EQ(device.ask(sync), "385 00 00");
}

TEST(TpdoStartValue, CountsFromTheSyncWithThisCounter) {
  Bench device;
  device.ask("605 2F 19 10 00 0A 00 00 00");  // SYNC counter overflow value 10
  device.ask("605 2F 01 18 02 FF 00 00 00");  // TPDO2 is not synchronous
  device.ask("605 23 02 18 01 85 03 00 80");
  device.ask("605 2F 02 18 06 03 00 00 00");  // start value 3
  device.ask("605 2F 02 18 02 02 00 00 00");  // every second SYNC
  device.ask("605 23 02 18 01 85 03 00 00");
  device.ask(bench::start);
  EXPECT_EQ(device.ask("080 01"), "");
  EXPECT_EQ(device.ask("080 02"), "");
  EXPECT_EQ(device.ask("080 03"), "");  // start value: the first SYNC of the TPDO
  EXPECT_EQ(device.ask("080 04"), "385 00 00");
  EXPECT_EQ(device.ask("080 05"), "");
  EXPECT_EQ(device.ask("080 06"), "385 00 00");
}

TEST(TpdoStartValue, MeansNothingWithoutASyncCounter) {
  Bench device;
  device.ask("605 23 02 18 01 85 03 00 80");
  device.ask("605 2F 02 18 06 03 00 00 00");
  device.ask("605 23 02 18 01 85 03 00 00");
  device.ask(bench::start);
  EXPECT_EQ(device.ask(sync), "285 00 | 385 00 00");
}

TEST(TpdoStartValue, CannotChangeWhileTheTpdoIsValid) {
  Bench device;
  EXPECT_EQ(device.ask("605 2F 02 18 06 03 00 00 00"), "585 80 02 18 06 22 00 00 08");
  EXPECT_EQ(device.ask("605 2F 02 18 06 00 00 00 00"), "585 60 02 18 06 00 00 00 00");  // the present value
}

TEST(TpdoStartValue, IsACounterOfASync) {
  Bench device;
  device.ask("605 23 02 18 01 85 03 00 80");
  EXPECT_EQ(device.ask("605 2F 02 18 06 F0 00 00 00"), "585 60 02 18 06 00 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 18 06 F1 00 00 00"), "585 80 02 18 06 30 00 09 06");
}

TEST(TpdoSync, CarriesTheValuesOfTheSyncNotThoseThatItBrings) {
  Bench device;
  // RPDO2 (type 1) writes 2000h, TPDO2 (here of type 1) sends it.
  device.ask("605 2F 01 18 02 01 00 00 00");
  device.ask(bench::start);
  EXPECT_EQ(device.ask("305 77"), "");
  EXPECT_EQ(device.ask(sync), "285 00 | 385 00 00");
  EXPECT_EQ(device.ask(sync), "285 77 | 385 00 00");
}

TEST(TpdoSync, HasNoEffectBeforeOperational) {
  Bench device;
  EXPECT_EQ(device.ask(sync), "");
  device.ask(bench::start);
  device.ask(bench::stop);
  EXPECT_EQ(device.ask(sync), "");
}

TEST(TpdoSync, FollowsANewCobIdOfTheSync) {
  Running device;
  device.ask("605 23 05 10 00 81 00 00 00");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask("081"), "385 00 00");
}

TEST(TpdoSync, WaitsForRoomOnTheBus) {
  Running device;
  device.bus.room = 0;
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s), "385 00 00");
}

// Remote frames

TEST(TpdoRemote, IsAnsweredByAnEventDrivenTpdo) {
  Running device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 23 00 18 01 85 01 00 00");  // bit 30 is 0: remote frames
  EXPECT_EQ(device.ask("185 R 6"), "185 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("185 R 0"), "185 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("186 R 6"), "");
}

TEST(TpdoRemote, IsNotAnsweredWhereBit30ForbidsIt) {
  Running device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 23 00 18 01 85 01 00 40");
  EXPECT_EQ(device.ask("185 R 6"), "");
}

TEST(TpdoRemote, IsAnsweredInOperationalOnly) {
  Bench device;
  EXPECT_EQ(device.ask("185 R 6"), "");
}

TEST(TpdoType252, SendsTheDataOfTheLastSyncWhenAsked) {
  Running device;
  device.ask("605 2F 02 18 02 FC 00 00 00");
  device.node.set<od::input_word>(0x1234);
  device.pass(0s);  // TPDO1
  EXPECT_EQ(device.ask("385 R 2"), "385 00 00");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask("385 R 2"), "385 34 12");
}

TEST(TpdoType252, SendsTheDataOfItsBeginningBeforeTheFirstSync) {
  Running device;
  device.node.set<od::input_word>(0x1234);
  device.pass(0s);  // TPDO1
  device.ask("605 2F 02 18 02 FC 00 00 00");
  EXPECT_EQ(device.ask("385 R 2"), "385 34 12");
}

TEST(TpdoType253, SendsTheDataOfNowWhenAsked) {
  Running device;
  device.ask("605 2F 02 18 02 FD 00 00 00");
  device.node.set<od::input_word>(0x1234);
  EXPECT_EQ(device.pass(1s), "185 34 12 00 00 00 00");
  EXPECT_EQ(device.ask(sync), "");
  EXPECT_EQ(device.ask("385 R 2"), "385 34 12");
}

TEST(TpdoRemote, WaitsForTheInhibitTime) {
  Running device;
  device.ask("605 23 00 18 01 85 01 00 80");
  device.ask("605 2B 00 18 03 64 00 00 00");  // 10 ms
  device.ask("605 23 00 18 01 85 01 00 00");
  EXPECT_EQ(device.ask("185 R 6"), "185 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("185 R 6"), "");
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), "185 00 00 00 00 00 00");
}

/// TPDO1 has an inhibit time of 10 ms, which starts now.
struct Inhibited : Bench {
  Inhibited() {
    ask("605 23 00 18 01 85 01 00 80");
    ask("605 2B 00 18 03 64 00 00 00");
    ask("605 23 00 18 01 85 01 00 40");
    ask(bench::start);
  }
};

TEST(TpdoTransmissionType, KeepsAChangeThatWaitsWhenItIsWritten) {
  Inhibited device;
  device.node.set<od::input_word>(7);
  EXPECT_EQ(device.ask("605 2F 00 18 02 FE 00 00 00"), "585 60 00 18 02 00 00 00 00");
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), "185 07 00 00 00 00 00");
}

TEST(TpdoTransmissionType, SynchronousDoesNotWaitForTheInhibitTime) {
  Inhibited device;
  device.ask("605 2F 00 18 02 01 00 00 00");
  EXPECT_EQ(device.ask(sync), "185 00 00 00 00 00 00 | 285 00 | 385 00 00");
}

TEST(TpdoInhibitTime, IsNotForSynchronousTpdos) {
  Inhibited device;
  device.ask("605 2F 00 18 02 01 00 00 00");
  device.ask(sync);
  EXPECT_EQ(device.ask(sync), "185 00 00 00 00 00 00 | 385 00 00");
}

TEST(TpdoInhibitTime, GoesOnWhileTheTpdoIsNotValid) {
  Inhibited device;
  device.ask("605 23 00 18 01 85 01 00 C0");
  device.ask("605 23 00 18 01 85 01 00 40");
  device.node.set<od::input_word>(7);
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), "185 07 00 00 00 00 00");
}

}  // namespace
