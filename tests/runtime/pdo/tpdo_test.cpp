#include <gtest/gtest.h>

#include "support/bench.hpp"

namespace {

using bench::Bench;
using canopen::AbortCode;
namespace od = sample::od;
using namespace std::chrono_literals;

constexpr auto zeros = "185 00 00 00 00 00 00";

/// An inhibit time, as the bytes of 1800h:03.
constexpr std::uint8_t ten_milliseconds[] = {100, 0};

TEST(Tpdo, IsSentOnceOnEnteringOperational) {
  Bench device;
  EXPECT_EQ(device.ask(bench::start), zeros);
  EXPECT_EQ(device.pass(10s), "");
  EXPECT_EQ(device.ask(bench::start), "");
}

TEST(Tpdo, IsSentWhenTheApplicationSetsANewValue) {
  Bench device;
  device.ask(bench::start);
  device.node.set<od::statusword>(0x0231);
  EXPECT_EQ(device.node.next_deadline(), device.now);
  EXPECT_EQ(device.pass(0ms), "185 31 02 00 00 00 00");
  device.node.set<od::statusword>(0x0231);
  EXPECT_FALSE(device.node.next_deadline());
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Tpdo, CarriesAllValuesSetBeforeItGoesOut) {
  Bench device;
  device.ask(bench::start);
  device.node.set<od::statusword>(0x0231);
  device.node.set<od::position_actual_value>(-2);
  EXPECT_EQ(device.pass(1s), "185 31 02 FE FF FF FF");
}

TEST(Tpdo, IsSentWhenAToolSetsAMappedObjectByNumber) {
  Bench device;
  device.ask(bench::start);
  const std::uint8_t bytes[] = {0x01, 0x02};
  EXPECT_EQ(device.node.set(0x6041, 0, bytes), canopen::ok);
  EXPECT_EQ(device.pass(0ms), "185 01 02 00 00 00 00");
}

TEST(Tpdo, IsNotSentForAnObjectThatItDoesNotCarry) {
  Bench device;
  device.ask(bench::start);
  device.node.set<od::integer16_value>(5);
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Tpdo, IsSentInOperationalOnly) {
  Bench device;
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.pass(1s), "");
  device.ask(bench::start);
  device.ask(bench::stop);
  device.node.set<od::statusword>(2);
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Tpdo, IsNotSentWhileItsCobIdIsInvalid) {
  Bench device;
  device.ask(bench::start);
  device.node.set<od::inputs::input_1>(true);
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Tpdo, PacksObjectsAtAnyBit) {
  Bench device;
  device.ask("605 23 01 18 01 85 02 00 40");
  device.node.set<od::inputs::input_2>(true);
  EXPECT_EQ(device.node.set<od::integer40_value>(-1), canopen::ok);
  EXPECT_EQ(device.node.set<od::error_register>(canopen::raw(0x81)), canopen::ok);
  EXPECT_EQ(device.ask(bench::start), std::string{zeros} + " | 285 FE FF FF FF FF 07 02");
}

TEST(Tpdo, TakesANewCobIdAtOnce) {
  Bench device;
  device.ask(bench::start);
  device.ask("605 23 00 18 01 85 01 00 C0");  // invalid first
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.pass(1s), "");
  device.ask("605 23 00 18 01 33 03 00 40");
  device.node.set<od::statusword>(2);
  EXPECT_EQ(device.pass(1s), "333 02 00 00 00 00 00");
}

TEST(Tpdo, MayHaveA29BitCanId) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 C0");
  device.ask("605 23 00 18 01 78 56 34 72");
  EXPECT_EQ(device.ask(bench::start), "12345678 00 00 00 00 00 00");
}

TEST(Tpdo, IsSentEachTimeTheEventTimerRunsOut) {
  Bench device;
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(10)), canopen::ok);
  device.ask(bench::start);
  EXPECT_EQ(device.node.next_deadline(), device.now + 10ms);
  EXPECT_EQ(device.pass(9ms), "");
  EXPECT_EQ(device.pass(1ms), zeros);
  EXPECT_EQ(device.pass(20ms), std::string{zeros} + " | " + zeros);
}

TEST(Tpdo, ItsEventTimerDoesNotDriftWhenServedLate) {
  Bench device;
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(10)), canopen::ok);
  device.ask(bench::start);
  device.now = device.now + 13ms;
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), zeros);
  EXPECT_EQ(device.pass(6999us), "");
  EXPECT_EQ(device.pass(1us), zeros);
  device.now = device.now + 25ms;  // two periods have passed: one TPDO is sent
  device.node.on_time(device.now);
  EXPECT_EQ(device.bus.take(), zeros);
  EXPECT_EQ(device.pass(9999us), "");
  EXPECT_EQ(device.pass(1us), zeros);
}

TEST(Tpdo, EveryTransmissionRestartsTheEventTimer) {
  Bench device;
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(10)), canopen::ok);
  device.ask(bench::start);
  device.pass(6ms);
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.pass(9ms), "185 01 00 00 00 00 00");
  EXPECT_EQ(device.pass(1ms), "185 01 00 00 00 00 00");
}

TEST(Tpdo, AnEventTimerWrittenInOperationalCountsAtOnce) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(device.ask("605 2B 00 18 05 14 00 00 00"), "585 60 00 18 05 00 00 00 00");
  EXPECT_EQ(device.pass(20ms), zeros);
  device.ask("605 2B 00 18 05 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
}

TEST(Tpdo, IsNotSentAgainBeforeTheInhibitTimeIsOver) {
  Bench device;
  EXPECT_EQ(device.node.set(0x1800, 3, ten_milliseconds), canopen::ok);
  device.ask(bench::start);
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.node.next_deadline(), device.now + 10ms);
  EXPECT_EQ(device.pass(9ms), "");
  device.node.set<od::statusword>(2);
  EXPECT_EQ(device.pass(1ms), "185 02 00 00 00 00 00");
  EXPECT_EQ(device.pass(1s), "");
  device.node.set<od::statusword>(3);
  EXPECT_EQ(device.pass(0ms), "185 03 00 00 00 00 00");
}

TEST(Tpdo, TheInhibitTimeHoldsTheEventTimerBackToo) {
  Bench device;
  EXPECT_EQ(device.node.set(0x1800, 3, ten_milliseconds), canopen::ok);
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(3)), canopen::ok);
  device.ask(bench::start);
  EXPECT_EQ(device.node.next_deadline(), device.now + 10ms);
  EXPECT_EQ(device.pass(9ms), "");
  EXPECT_EQ(device.pass(1ms), zeros);
}

TEST(Tpdo, StaysPendingUntilTheBusHasRoom) {
  Bench device;
  device.ask(bench::start);
  device.bus.room = 0;
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.pass(1ms), "");
  EXPECT_EQ(device.node.next_deadline(), device.now);
  device.node.set<od::statusword>(2);
  device.bus.room = 10;
  EXPECT_EQ(device.pass(1ms), "185 02 00 00 00 00 00");
}

TEST(Tpdo, ThoseOfSynchronousAndRemoteTypesAreNotSentOnAChange) {
  for (const std::string type : {"00", "01", "F0", "FC", "FD"}) {
    Bench device;
    EXPECT_EQ(device.ask("605 2F 00 18 02 " + type + " 00 00 00"), "585 60 00 18 02 00 00 00 00");
    EXPECT_EQ(device.ask(bench::start), "");
    device.node.set<od::statusword>(1);
    EXPECT_EQ(device.pass(1s), "") << type;
    EXPECT_FALSE(device.node.next_deadline());
  }
}

TEST(Tpdo, ReservedTransmissionTypesAreRefused) {
  Bench device;
  for (const std::string type : {"F1", "FB"}) {
    EXPECT_EQ(device.ask("605 2F 00 18 02 " + type + " 00 00 00"), "585 80 00 18 02 30 00 09 06") << type;
  }
}

TEST(Tpdo, ItsCanIdCannotChangeWhileItIsValid) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 00 18 01 86 01 00 40"), "585 80 00 18 01 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 00 18 01 85 01 00 40"), "585 60 00 18 01 00 00 00 00");
}

TEST(Tpdo, CannotBeMadeValidWithARestrictedCanId) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 C0");
  for (const std::string id :
       {"00 00", "01 00", "7F 00", "01 01", "80 01", "81 05", "01 06", "E0 06", "01 07", "80 07"}) {
    EXPECT_EQ(device.ask("605 23 00 18 01 " + id + " 00 40"), "585 80 00 18 01 30 00 09 06") << id;
    EXPECT_EQ(device.ask("605 23 00 18 01 " + id + " 00 C0"), "585 60 00 18 01 00 00 00 00") << id;
  }
}

TEST(Tpdo, An11BitCanIdHasNoBitsAbove) {
  Bench device;
  device.ask("605 23 00 18 01 85 01 00 C0");
  EXPECT_EQ(device.ask("605 23 00 18 01 85 09 00 40"), "585 80 00 18 01 30 00 09 06");
}

TEST(Tpdo, ItsInhibitTimeCannotChangeWhileItIsValid) {
  Bench device;
  EXPECT_EQ(device.ask("605 2B 00 18 03 64 00 00 00"), "585 80 00 18 03 22 00 00 08");
  EXPECT_EQ(device.ask("605 2B 00 18 03 00 00 00 00"), "585 60 00 18 03 00 00 00 00");
  device.ask("605 23 00 18 01 85 01 00 C0");
  EXPECT_EQ(device.ask("605 2B 00 18 03 64 00 00 00"), "585 60 00 18 03 00 00 00 00");
}

TEST(Tpdo, ItsMappingIsFixed) {
  Bench device;
  EXPECT_EQ(device.ask("605 23 00 1A 01 10 00 41 60"), "585 80 00 1A 01 02 00 01 06");
  EXPECT_EQ(device.ask("605 40 00 1A 02 00 00 00 00"), "585 43 00 1A 02 20 00 64 60");
}

struct InhibitAlwaysWritable : sample::Device {
  static constexpr canopen::DeviceOptions options{.inhibit_time_writable_while_valid = true};
};

TEST(Tpdo, AnOptionLetsTheInhibitTimeChangeAtAnyTime) {
  Bench<InhibitAlwaysWritable> device;
  EXPECT_EQ(device.ask("605 2B 00 18 03 F0 20 00 00"), "585 60 00 18 03 00 00 00 00");
}

struct TimerOnly : sample::Device {
  static constexpr canopen::DeviceOptions options{.event_driven_on_change = false};
};

TEST(Tpdo, AnOptionLeavesSendingToTheEventTimerAlone) {
  Bench<TimerOnly> device;
  EXPECT_EQ(device.node.set<od::tpdo_communication_parameter_1::event_timer>(canopen::raw(1)), canopen::ok);
  EXPECT_EQ(device.ask(bench::start), "");
  device.node.set<od::statusword>(1);
  EXPECT_EQ(device.pass(999us), "");
  EXPECT_EQ(device.pass(1us), "185 01 00 00 00 00 00");
}

struct MaskedCobId : sample::Device {
  static constexpr canopen::DeviceOptions options{.pdo_cob_id_writable = 0x8000'0780};
};

TEST(Tpdo, AnOptionKeepsBitsOfTheCobIdAsTheyAre) {
  Bench<MaskedCobId> device;
  EXPECT_EQ(device.ask("605 23 01 18 01 81 02 00 04"), "585 60 01 18 01 00 00 00 00");
  EXPECT_EQ(canopen::to_raw(device.node.get<od::tpdo_communication_parameter_2::cob_id_used_by_tpdo>()), 0x40000285u);
}

struct PlainCanIds : sample::Device {
  static constexpr canopen::DeviceOptions options{.pdo_extended_ids = false, .tpdo_remote_frames = false};
};

TEST(Tpdo, OptionsRefuse29BitCanIdsAndRemoteFrames) {
  Bench<PlainCanIds> device;
  EXPECT_EQ(device.ask("605 23 01 18 01 85 02 00 E0"), "585 80 01 18 01 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 01 18 01 85 02 00 00"), "585 80 01 18 01 30 00 09 06");
  EXPECT_EQ(device.ask("605 2F 01 18 02 FC 00 00 00"), "585 80 01 18 02 30 00 09 06");
  EXPECT_EQ(device.ask("605 23 01 18 01 85 02 00 40"), "585 60 01 18 01 00 00 00 00");
}

}  // namespace
