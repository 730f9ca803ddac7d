/// When received values take effect: transmission types, deadlines, COB-IDs and lengths; SYNC.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>

#include "pdo_transmission_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::RpdoEvent;
using transmission_bench::Bench;
using transmission_bench::Running;
using transmission_bench::sync;
namespace od = pdo_device::od;
using namespace std::chrono_literals;

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
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0x11);
  EXPECT_EQ(device.ask("205 01 02 03 04 05"), "");  // reported once
  EXPECT_EQ(device.ask("205 01 02 03 04 05 06"), "085 00 00 00 00 00 00 00 00 | 185 00 00 03 04 05 06");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x0201);
  EXPECT_EQ(canopen::to_raw(device.node.get<od::error_register>()), 0);
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
