/// SYNC, TIME and EMCY of other nodes: production, consumption, and valid parameters.
#include <gtest/gtest.h>

#include <sync_device/device.hpp>

#include "support/bench.hpp"

namespace {

namespace od = sync_device::od;
using namespace std::chrono_literals;

using Bench = bench::Bench<sync_device::Device>;

constexpr auto ok = "585 60";

/// An SDO download; returns the first two bytes of the answer, or the whole abort.
std::string write(Bench& device, const std::string& request) {
  const std::string answer = device.ask(request);
  return answer.starts_with(ok) ? ok : answer;
}

TEST(SyncProducer, SendsEveryPeriodFromOnePeriodOn) {
  Bench device;
  EXPECT_EQ(write(device, "605 23 06 10 00 E8 03 00 00"), ok);  // 1000 us
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_EQ(write(device, "605 23 05 10 00 80 00 00 40"), ok);
  EXPECT_EQ(device.pass(999us), "");
  EXPECT_EQ(device.pass(1us), "080");
  EXPECT_EQ(device.pass(999us), "");
  EXPECT_EQ(device.pass(1001us), "080 | 080");
}

TEST(SyncProducer, TakesItsOwnSync) {
  Bench device;
  write(device, "605 23 06 10 00 E8 03 00 00");
  write(device, "605 23 05 10 00 80 00 00 40");
  device.ask(bench::start);
  device.node.set<od::input>(7);
  EXPECT_EQ(device.ask("205 09"), "");
  EXPECT_EQ(device.pass(1ms), "080 | 185 07");
  EXPECT_EQ(device.node.get<od::output>(), 9);
}

TEST(SyncProducer, CountsFrom1ToTheOverflowValue) {
  Bench device;
  write(device, "605 2F 19 10 00 03 00 00 00");
  write(device, "605 23 06 10 00 E8 03 00 00");
  write(device, "605 23 05 10 00 80 00 00 40");
  EXPECT_EQ(device.pass(5ms), "080 01 | 080 02 | 080 03 | 080 01 | 080 02");
}

TEST(SyncProducer, CountsFrom1AgainAfterStopped) {
  Bench device;
  write(device, "605 2F 19 10 00 0A 00 00 00");
  write(device, "605 23 06 10 00 E8 03 00 00");
  write(device, "605 23 05 10 00 80 00 00 40");
  device.pass(3ms);
  device.ask(bench::stop);
  EXPECT_EQ(device.pass(3ms), "");
  device.ask(bench::enter_pre_operational);
  EXPECT_EQ(device.pass(2ms), "080 01 | 080 02");
  device.ask(bench::start);
  EXPECT_EQ(device.pass(1ms), "080 03 | 185 00");
}

TEST(SyncProducer, StopsWithBit30OrWithoutAPeriod) {
  Bench device;
  write(device, "605 23 06 10 00 E8 03 00 00");
  write(device, "605 23 05 10 00 80 00 00 40");
  EXPECT_EQ(device.pass(1ms), "080");
  write(device, "605 23 05 10 00 80 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
  write(device, "605 23 05 10 00 80 00 00 40");
  write(device, "605 23 06 10 00 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
  EXPECT_FALSE(device.node.next_deadline());
}

TEST(SyncProducer, DoesNotDriftWhenServedLate) {
  Bench device;
  write(device, "605 23 06 10 00 E8 03 00 00");
  write(device, "605 23 05 10 00 80 00 00 40");
  device.node.on_time(device.now + 1400us);
  EXPECT_EQ(device.bus.take(), "080");
  device.now = device.now + 1999us;
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), "");
  EXPECT_EQ(device.pass(1us), "080");
}

TEST(SyncProducer, GoesOnWhenABusWithoutRoomForLongerThanMomentsCompareHasRoomAgain) {
  Bench device;
  write(device, "605 23 06 10 00 40 42 0F 00");  // 1 s
  write(device, "605 23 05 10 00 80 00 00 40");
  device.bus.room = 0;
  device.pass(20min);
  device.pass(20min);
  device.bus.room = 100;
  EXPECT_EQ(device.pass(0s), "080");
  EXPECT_EQ(device.pass(1s), "080");
}

TEST(SyncProducer, HasAPeriodOf35MinutesAtMost) {
  Bench device;
  write(device, "605 23 05 10 00 80 00 00 40");
  EXPECT_EQ(write(device, "605 23 06 10 00 00 00 00 80"), "585 80 06 10 00 31 00 09 06");
  EXPECT_EQ(write(device, "605 23 06 10 00 FF FF FF 7F"), ok);
  EXPECT_EQ(device.pass(20min), "");
  EXPECT_EQ(device.pass(16min), "080");
  EXPECT_EQ(device.node.set<od::communication_cycle_period>(canopen::raw(0x8000'0000)),
            canopen::AbortCode::value_too_high);
}

TEST(SyncWindow, OfMoreThan35MinutesIsNone) {
  Bench device;
  write(device, "605 23 07 10 00 00 00 00 80");
  device.ask(bench::start);
  device.ask("080");
  device.pass(1ms);
  device.ask("205 07");
  device.ask("080");
  EXPECT_EQ(device.node.get<od::output>(), 7);
}

TEST(SyncParameter, IdentifierStaysWhileSyncIsProduced) {
  Bench device;
  write(device, "605 23 05 10 00 80 00 00 40");
  EXPECT_EQ(write(device, "605 23 05 10 00 81 00 00 40"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(write(device, "605 23 05 10 00 81 00 00 00"), ok);
}

TEST(SyncParameter, IdentifierIsNoRestrictedOne) {
  Bench device;
  EXPECT_EQ(write(device, "605 23 05 10 00 01 07 00 00"), "585 80 05 10 00 30 00 09 06");
  EXPECT_EQ(write(device, "605 23 05 10 00 00 08 00 00"), "585 80 05 10 00 30 00 09 06");  // more than 11 bits
  EXPECT_EQ(write(device, "605 23 05 10 00 81 00 00 00"), ok);
}

TEST(SyncParameter, CounterHasReservedValues) {
  Bench device;
  for (const char* reserved : {"01", "F1", "FF"}) {
    EXPECT_EQ(write(device, std::string{"605 2F 19 10 00 "} + reserved + " 00 00 00"), "585 80 19 10 00 30 00 09 06");
  }
  for (const char* good : {"02", "F0", "00"}) {
    EXPECT_EQ(write(device, std::string{"605 2F 19 10 00 "} + good + " 00 00 00"), ok);
  }
}

TEST(SyncParameter, CounterStaysWhileThereIsAPeriod) {
  Bench device;
  write(device, "605 23 06 10 00 E8 03 00 00");
  EXPECT_EQ(write(device, "605 2F 19 10 00 0A 00 00 00"), "585 80 19 10 00 22 00 00 08");
}

TEST(SyncWindow, DropsWhatCouldNotBeSentInIt) {
  Bench device;
  write(device, "605 23 07 10 00 64 00 00 00");  // 100 us
  device.ask(bench::start);
  EXPECT_EQ(device.ask("080"), "185 00");
  device.bus.room = 0;
  EXPECT_EQ(device.ask("080"), "");
  device.bus.room = 100;
  device.now = device.now + 101us;
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), "");
  EXPECT_EQ(device.ask("080"), "185 00");
}

TEST(SyncWindow, LimitsWhatASyncWantsNotWhatARemoteFrameAsksFor) {
  Bench device;
  write(device, "605 23 07 10 00 64 00 00 00");
  device.ask(bench::start);
  EXPECT_EQ(device.ask("080"), "185 00");
  device.now = device.now + 101us;
  EXPECT_EQ(device.ask("185 R 1"), "185 00");
}

TEST(SyncWindow, LetsRpdosInUntilItsEnd) {
  Bench device;
  write(device, "605 23 07 10 00 64 00 00 00");
  device.ask(bench::start);
  device.ask("080");
  device.now = device.now + 100us;
  device.ask("205 01");
  device.now = device.now + 1us;
  device.ask("205 02");  // too late
  device.ask("080");
  EXPECT_EQ(device.node.get<od::output>(), 1);
}

TEST(SyncWindow, EndsWhenItIsDisabled) {
  Bench device;
  write(device, "605 23 07 10 00 E8 03 00 00");  // 1 ms
  device.ask(bench::start);
  device.ask("080");
  device.pass(2ms);
  device.ask("205 07");
  device.ask("080");
  EXPECT_EQ(device.node.get<od::output>(), 0) << "the window is over";
  device.pass(2ms);
  write(device, "605 23 07 10 00 00 00 00 00");
  device.ask("205 07");
  device.ask("080");
  EXPECT_EQ(device.node.get<od::output>(), 7);
}

TEST(HighResolutionTimeStamp, IsTheTimeOfTheLastSync) {
  Bench device;
  device.pass(1234us);
  device.ask("080");
  device.pass(1s);
  EXPECT_EQ(device.ask("605 40 13 10 00 00 00 00 00"), "585 43 13 10 00 D2 04 00 00");
}

TEST(HighResolutionTimeStamp, GoesOnFromWhatIsWritten) {
  Bench device;
  device.pass(10us);
  EXPECT_EQ(write(device, "605 23 13 10 00 00 10 00 00"), ok);  // 4096 us
  device.pass(5us);
  device.ask("080");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::high_resolution_time_stamp>()), 4101u);
}

TEST(Time, IsGivenToTheApplication) {
  std::string log;
  auto device = bench::with<sync_device::Device>(canopen::on_time_of_day([&](canopen::TimeOfDay time) {
    log += std::to_string(time.days) + "d" + std::to_string(time.milliseconds) + "ms ";
  }));
  device.ask("100 E8 03 00 F0 0A 00");  // the upper four bits are not part of the time
  device.ask("100 E8 03 00 00 0A");     // too short
  device.ask(bench::stop);
  device.ask("100 E8 03 00 00 0A 00");
  EXPECT_EQ(log, "10d1000ms ");
}

TEST(Time, IsSentByAProducer) {
  Bench device;
  EXPECT_FALSE(device.node.send_time({1000, 10}));
  EXPECT_EQ(write(device, "605 23 12 10 00 00 01 00 40"), ok);
  EXPECT_TRUE(device.node.send_time({1000, 10}));
  EXPECT_EQ(device.pass(0s), "100 E8 03 00 00 0A 00");
  device.ask(bench::stop);
  EXPECT_FALSE(device.node.send_time({1000, 10}));
}

TEST(Time, HasACanIdOf11BitsWhateverTheApplicationSets) {
  Bench device;
  EXPECT_EQ(device.node.set<od::cob_id_time>(canopen::raw(0x4000'0900)), canopen::AbortCode::invalid_value);
  EXPECT_EQ(device.node.set<od::cob_id_time>(canopen::raw(0x4000'0100)), canopen::ok);
  EXPECT_TRUE(device.node.send_time({1000, 10}));
  EXPECT_EQ(device.pass(0s), "100 E8 03 00 00 0A 00");
}

TEST(Time, IdentifierStaysWhileItIsInUse) {
  Bench device;
  EXPECT_EQ(write(device, "605 23 12 10 00 FF 00 00 80"), "585 80 12 10 00 30 00 09 06");
  EXPECT_EQ(write(device, "605 23 12 10 00 FF 00 00 00"), ok);
  EXPECT_EQ(write(device, "605 23 12 10 00 FE 00 00 80"), ok);
}

TEST(EmcyConsumer, HearsTheNodesOf1028h) {
  std::string log;
  std::array<std::uint8_t, 5> info{};
  auto device = bench::with<sync_device::Device>(canopen::on_emergency([&](canopen::ConsumedEmergency emergency) {
    info = emergency.message.info;
    log +=
        std::to_string(emergency.sub_index) + ":" + std::string{canopen::emergency_text(emergency.message.code)} + " ";
  }));
  device.ask("082 10 82 11 01 02 03 04 05");
  EXPECT_EQ(info, (std::array<std::uint8_t, 5>{1, 2, 3, 4, 5}));
  device.ask("082 10 82 11 09");  // incomplete EMCY
  device.ask("083 10 82 11 09 00 00 00 00");
  EXPECT_EQ(log, "2:PDO not processed, too short ");
  device.ask("605 23 28 10 03 83 00 00 00");
  device.ask("083 11 42 11 09 00 00 00 00");
  EXPECT_EQ(log, "2:PDO not processed, too short 3:device temperature ");
}

}  // namespace
