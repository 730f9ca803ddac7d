/// Multiplex PDOs frame by frame: destination and source addressing mode, as consumer and as producer.
#include <gtest/gtest.h>

#include <array>
#include <canopen/host/virtual_bus.hpp>
#include <mpdo_device/device.hpp>
#include <pdo_device/device.hpp>
#include <span>
#include <vector>

#include "support/bench.hpp"

namespace {

using canopen::MpdoDestination;
using canopen::NodeId;
using canopen::RpdoEvent;
namespace od = mpdo_device::od;
using namespace std::chrono_literals;

using Bench = bench::Bench<mpdo_device::Device>;

/// Operational. RPDO1 (205h) and TPDO2 (285h) are in destination addressing mode, RPDO2 (305h) and TPDO1 (185h) in
/// source addressing mode; RPDO3 and TPDO3 are not valid, and their mapping is dynamic.
struct Running : Bench {
  Running() { ask(bench::start); }
};

// The lists: an array of up to 254 elements of 32 bits (1FA0h) or 64 bits (1FD0h), and a number of one byte (CiA 301,
// 7.5.2.41 and 7.5.2.42).

namespace entry = canopen::entry;

/// A device with a list of four elements.
template <std::uint16_t Index, entry::Word Count, entry::Word Element>
struct DeviceWithList {
  static constexpr canopen::Run runs[] = {{Index, 0}, {0xFFFF, 1}};
  static constexpr entry::Word entries[] = {entry::array | 0};
  static constexpr canopen::Group groups[] = {{.ram = 0, .rom = 0, .subs = 0, .highest = 4, .stride = 8}};
  static constexpr entry::Word subs[] = {entry::ram | entry::rw | Count, entry::ram | entry::rw | Element | 8};
  static constexpr canopen::Dictionary dictionary{.runs = runs,
                                                  .entries = entries,
                                                  .groups = groups,
                                                  .subs = subs,
                                                  .limits = {},
                                                  .wide_limits = {},
                                                  .constants = nullptr};
};
template <entry::Word Count, entry::Word Element, std::uint16_t Index = 0x1FA0>
constexpr std::uint8_t scanned =
    canopen::MpdoLists<DeviceWithList<Index, Count, Element>, canopen::ScannedObjects>::capacity(Index);
template <entry::Word Count, entry::Word Element, std::uint16_t Index = 0x1FD0>
constexpr std::uint8_t dispatched =
    canopen::MpdoLists<DeviceWithList<Index, Count, Element>, canopen::DispatchedObjects>::capacity(Index);

static_assert(scanned<entry::u8, entry::u32> == 4);
static_assert(scanned<entry::u16, entry::u32> == 0, "the number of elements has one byte");
static_assert(scanned<entry::u8, entry::u16> == 0 && scanned<entry::u8, entry::u64> == 0);
static_assert(dispatched<entry::u8, entry::u64> == 4);
static_assert(dispatched<entry::u32, entry::u64> == 0 && dispatched<entry::u8, entry::u32> == 0);

template <class Element>
using ListsOf = canopen::MpdoLists<DeviceWithList<0x1FA0, entry::u8, entry::u32>, Element>;
static_assert(ListsOf<canopen::ScannedObjects>::contain(0x1FA0) && ListsOf<canopen::ScannedObjects>::contain(0x1FCF));
static_assert(!ListsOf<canopen::ScannedObjects>::contain(0x1F9F) && !ListsOf<canopen::ScannedObjects>::contain(0x1FD0));
static_assert(ListsOf<canopen::DispatchedObjects>::contain(0x1FD0) &&
              ListsOf<canopen::DispatchedObjects>::contain(0x1FFF));
static_assert(!ListsOf<canopen::DispatchedObjects>::contain(0x1FCF) &&
              !ListsOf<canopen::DispatchedObjects>::contain(0x2000));

TEST(MpdoLists, OfTheirNumberOneByteIsLookedAt) {
  Bench device;
  // The bytes after this one would mean a block of 255 objects.
  const std::array<std::uint8_t, 4> memory{1, 0xFF, 0xFF, 0xFF};
  using Check = canopen::MpdoCheck<mpdo_device::Device>;
  EXPECT_EQ(Check::check(device.node.entries(), 0x1FA0, 0, std::span{memory}.first(1)), canopen::ok);
  EXPECT_EQ(Check::check(device.node.entries(), 0x1FD0, 0, std::span{memory}.first(1)), canopen::ok);
}

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
  EXPECT_TRUE(device.node.send_mpdo({NodeId{0}, 0x6041, 2}, 0x12345678));
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

// PDOs that SDO turns into MPDOs

TEST(DynamicMpdo, ConsumesInEitherMode) {
  Running device;
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 60 02 16 00 00 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  device.ask("222 85 00 20 00 11 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x11);
  device.ask("605 23 02 14 01 22 02 00 80");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FE 00 00 00"), "585 60 02 16 00 00 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  device.ask("222 07 05 20 00 22 00 00 00");
  EXPECT_EQ(device.node.get<od::byte>(), 0x22);
}

TEST(DynamicMpdo, ProducesInDestinationAddressingMode) {
  Running device;
  device.ask("605 23 01 18 01 85 02 00 80");  // otherwise TPDO2 is the first DAM-TPDO
  EXPECT_EQ(device.ask("605 2F 02 1A 00 FF 00 00 00"), "585 60 02 1A 00 00 00 00 00");
  device.ask("605 23 02 18 01 33 03 00 00");
  EXPECT_TRUE(device.node.send_mpdo({NodeId{6}, 0x2000, 0}, 1));
  EXPECT_EQ(device.pass(0s), "333 86 00 20 00 01 00 00 00");
}

TEST(DynamicMpdo, RefusesASecondSamProducer) {
  Running device;
  EXPECT_EQ(device.ask("605 2F 02 1A 00 FE 00 00 00"), "585 80 02 1A 00 42 00 04 06");
}

TEST(DynamicMpdo, RefusesOtherTransmissionTypes) {
  Running device;
  device.ask("605 2F 02 14 02 01 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 80 02 16 00 42 00 04 06");
  device.ask("605 2F 02 14 02 FE 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 16 00 FF 00 00 00"), "585 60 02 16 00 00 00 00 00");
  EXPECT_EQ(device.ask("605 2F 02 14 02 01 00 00 00"), "585 80 02 14 02 30 00 09 06");
}

TEST(DynamicMpdo, IsRefusedWithoutTheOption) {
  static_assert(!canopen::MpdoService<pdo_device::Device>::exists);
  static_assert(std::is_empty_v<canopen::MpdoService<pdo_device::Device>>);
  bench::Bench<pdo_device::Device> device;
  device.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(device.ask("605 2F 00 1A 00 FF 00 00 00").substr(0, 6), "585 80");
}

// Two nodes

/// Nodes 5 and 7 on a bus; all frames are recorded.
struct TwoNodes {
  TwoNodes() {
    canopen::VirtualBus::connect(first_end, first);
    canopen::VirtualBus::connect(second_end, second);
    bus.listen([this](const canopen::Frame& frame, canopen::TimePoint) {
      log += (log.empty() ? "" : " | ") + bench::text(frame);
    });
    first.start(bus.now());
    second.start(bus.now());
    master.send(bench::frame("605 23 01 14 01 05 03 00 80"));
    master.send(bench::frame("605 23 00 14 01 05 02 00 80"));
    master.send(bench::frame("605 23 01 14 01 87 01 00 00"));  // RPDO2 of node 5 receives TPDO1 of node 7
    master.send(bench::frame("605 23 00 14 01 87 02 00 00"));  // and its RPDO1 receives TPDO2
    bus.run_for(1ms);
    master.send(bench::frame("000 01 00"));
    bus.run_for(1ms);
    log.clear();
  }

  canopen::VirtualBus bus;
  canopen::VirtualBus::Endpoint& master = bus.attach();
  canopen::VirtualBus::Endpoint& first_end = bus.attach();
  canopen::VirtualBus::Endpoint& second_end = bus.attach();
  canopen::Node<mpdo_device::Device, canopen::VirtualBus::Endpoint> first{first_end, NodeId{5}};
  canopen::Node<mpdo_device::Device, canopen::VirtualBus::Endpoint> second{second_end, NodeId{7}};
  std::string log;
};

TEST(TwoNodesWithMpdos, ExchangeAnObjectInSourceAddressingMode) {
  TwoNodes nodes;
  nodes.second.set<od::input>(0x1234);
  nodes.bus.run_for(1ms);
  // Node 5 writes 2004h of node 7 to its own 2001h and sends that.
  EXPECT_EQ(nodes.log, "187 07 04 20 00 34 12 00 00 | 185 05 01 20 00 34 12 00 00");
  EXPECT_EQ(nodes.first.get<od::word>(), 0x1234);
}

TEST(TwoNodesWithMpdos, ExchangeAnObjectInDestinationAddressingMode) {
  TwoNodes nodes;
  EXPECT_TRUE(nodes.second.send_mpdo({NodeId{5}, 0x2000, 0}, 0x5A));
  nodes.bus.run_for(1ms);
  EXPECT_EQ(nodes.log, "287 85 00 20 00 5A 00 00 00");
  EXPECT_EQ(nodes.first.get<od::byte>(), 0x5A);
}

}  // namespace
