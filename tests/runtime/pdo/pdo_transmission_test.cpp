/// When PDOs are sent and when received values take effect: transmission types, SYNC, remote frames, deadlines.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>

#include "support/bench.hpp"

namespace {

using canopen::RpdoEvent;
namespace od = pdo_device::od;
using namespace std::chrono_literals;

using Bench = bench::Bench<pdo_device::Device>;

constexpr auto sync = "080";

/// Operational; the PDOs that it sends on entering have been removed. TPDO2 (type 0) has sent its first data.
struct Running : Bench {
  Running() {
    ask(bench::start);
    ask(sync);
  }
};

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

// RPDOs: RPDO1 is event-driven, RPDO2 has type 1.

TEST(RpdoType1, IsTakenOverAtTheNextSync) {
  Running device;
  device.ask("305 11");
  device.ask("305 22");
  EXPECT_EQ(device.node.get<od::byte>(), 0);
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0x22);
  device.node.set<od::byte>(0);
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(RpdoType240, IsTakenOverAtTheNextSyncToo) {
  Running device;
  device.ask("605 2F 01 14 02 F0 00 00 00");
  device.ask("305 11");
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0x11);
}

TEST(RpdoType1, IsForgottenWhenTheNodeLeavesOperational) {
  Running device;
  device.ask("305 11");
  device.ask(bench::enter_pre_operational);
  device.ask(bench::start);
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(RpdoDeadline, IsMissedAfterTheEventTimer) {
  std::string log;
  auto device = bench::with<pdo_device::Device>(canopen::on_rpdo([&](RpdoEvent event, std::uint16_t number) {
    log += "0+-!?"[static_cast<int>(event)] + std::to_string(number) + " ";
  }));
  device.ask("605 2B 00 14 05 0A 00 00 00");  // 10 ms
  device.ask(bench::start);
  EXPECT_EQ(device.pass(1s), "");  // the deadline runs from the first frame on
  device.ask("205 01 00 00 00 00 00");
  EXPECT_EQ(device.pass(9999us), "");
  device.ask("205 01 00 00 00 00 00");
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(log, "01 01 ");
  EXPECT_EQ(device.pass(1us), "085 50 82 11 00 00 00 00 00");
  EXPECT_EQ(log, "01 01 -1 ");
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_EQ(device.ask("205 02 00 00 00 00 00"), "085 00 00 00 00 00 00 00 00");
  EXPECT_EQ(log, "01 01 -1 ?1 01 ");
}

TEST(RpdoDeadline, IsNotMissedOutsideOperational) {
  Bench device;
  device.ask("605 2B 00 14 05 0A 00 00 00");
  device.ask(bench::start);
  device.ask("205 01 00 00 00 00 00");
  device.ask(bench::enter_pre_operational);
  EXPECT_EQ(device.pass(1s), "");
}

TEST(RpdoDeadline, EndsWhenTheEventTimerIsSetTo0) {
  Running device;
  device.ask("605 2B 00 14 05 0A 00 00 00");
  device.ask("205 01 00 00 00 00 00");
  device.ask("605 2B 00 14 05 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
}

TEST(RpdoCobId, Bit30HasNoMeaning) {
  Running device;
  device.ask("605 23 00 14 01 05 02 00 80");
  device.ask("605 23 00 14 01 05 02 00 40");
  device.ask("205 01 02 00 00 00 00");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
}

TEST(RpdoCobId, OfTwoRpdosBringsAFrameToBoth) {
  Running device;
  device.ask("605 23 01 14 01 05 03 00 80");
  device.ask("605 23 01 14 01 05 02 00 00");
  device.ask("205 01 02 00 00 00 00");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0x01);
  device.ask("605 2F 00 14 02 01 00 00 00");  // both wait for the SYNC
  device.ask("205 03 04 00 00 00 00");
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0403);
  EXPECT_EQ(device.node.get<od::byte>(), 0x03);
}

TEST(RpdoCobId, MayLieOutsideThoseOfThePredefinedConnectionSet) {
  Running device;
  device.ask("605 23 01 14 01 05 03 00 80");
  device.ask("605 23 01 14 01 90 06 00 00");
  device.ask("690 11");
  device.ask("605 23 00 14 01 05 02 00 80");
  device.ask("605 23 00 14 01 05 02 00 20");
  device.ask("00000205 01 02 00 00 00 00");
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0x11);
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
}

TEST(SyncCobId, MayBeOneOfThoseOfPdos) {
  Running device;
  device.ask("605 23 05 10 00 50 02 00 00");
  device.ask("305 11");
  device.ask("250");
  EXPECT_EQ(device.node.get<od::byte>(), 0x11);
}

TEST(RpdoCobId, EndsTheErrorOfAShortFrameWhenItIsWritten) {
  Running device;
  EXPECT_EQ(device.ask("205 01"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 23 00 14 01 05 02 00 80"), "585 60 00 14 01 00 00 00 00 | 085 00 00 00 00 00 00 00 00");
}

TEST(RpdoType1, IsForgottenWhenItsParameterIsWritten) {
  Running device;
  device.ask("305 11");
  device.ask("605 23 01 14 01 05 03 00 80");
  device.ask("605 23 01 14 01 05 03 00 00");
  device.ask(sync);
  EXPECT_EQ(device.node.get<od::byte>(), 0);
}

TEST(RpdoLength, TooShortIsNotTakenAndTold) {
  Running device;
  EXPECT_EQ(device.ask("205 01 02 03 04 05"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(device.node.get<od::output_word>(), 0);
  EXPECT_EQ(device.node.get<od::error_register>(), 0x11);
  EXPECT_EQ(device.ask("205 01 02 03 04 05"), "");  // reported once
  EXPECT_EQ(device.ask("205 01 02 03 04 05 06"), "085 00 00 00 00 00 00 00 00 | 185 00 00 03 04 05 06");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
  EXPECT_EQ(device.node.get<od::error_register>(), 0);
}

TEST(RpdoLength, ErrorsOfTwoRpdosEndWithTheLast) {
  Running device;
  EXPECT_EQ(device.ask("205 01"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("305"), "085 10 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("305 01"), "");
  EXPECT_EQ(device.ask("205 00 00 00 00 00 00"), "085 00 00 00 00 00 00 00 00");
}

TEST(RpdoLength, OfALongerFrameTheFirstBytesAreUsed) {
  Running device;
  EXPECT_EQ(device.ask("205 01 02 00 00 00 00 77 88"), "");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
}

// SYNC

TEST(SyncLength, IsWatchedWhereThereIsACounter) {
  Bench device;
  device.ask("605 2F 19 10 00 0A 00 00 00");
  device.ask(bench::start);
  EXPECT_EQ(device.ask(sync), "085 40 82 11 00 00 00 00 00");
  EXPECT_EQ(device.ask("080 01"), "085 00 00 00 00 00 00 00 00 | 285 00 | 385 00 00");
}

TEST(SyncLength, IsZeroWithoutACounter) {
  Running device;
  EXPECT_EQ(device.ask("080 01"), "085 40 82 11 00 00 00 00 00");
}

TEST(SyncHandler, HearsTheCounter) {
  std::string log;
  auto device = bench::with<pdo_device::Device>(
      canopen::on_sync([&](std::uint8_t counter) { log += std::to_string(counter) + " "; }));
  device.ask(sync);
  device.ask("605 2F 19 10 00 0A 00 00 00");
  device.ask("080 07");
  device.ask(bench::stop);
  device.ask("080 08");
  EXPECT_EQ(log, "0 7 ");
}

}  // namespace
