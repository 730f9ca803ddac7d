/// Dynamic mapping: the procedure of CiA 301, 7.5.2.36, and each violation of it.
#include <gtest/gtest.h>

#include <pdo_device/device.hpp>
#include <static_pdo_device/device.hpp>

#include "support/bench.hpp"

namespace {

namespace od = pdo_device::od;
using namespace std::chrono_literals;

using Bench = bench::Bench<pdo_device::Device>;

/// An SDO download of at most four bytes; returns "ok" or the abort code.
std::string write(Bench& device, std::uint16_t index, std::uint8_t sub_index, std::uint32_t value, unsigned bytes) {
  canopen::Frame frame{.id = 0x605, .size = 8};
  frame.data = {static_cast<std::uint8_t>(0x23 | ((4 - bytes) << 2)), static_cast<std::uint8_t>(index),
                static_cast<std::uint8_t>(index >> 8), sub_index};
  for (unsigned i = 0; i < 4; ++i) frame.data.at(4 + i) = static_cast<std::uint8_t>(value >> (8 * i));
  device.node.on_frame(frame, device.now);
  const canopen::Frame answer = device.bus.sent.back();
  device.bus.take();
  if (answer.data[0] == 0x60) return "ok";
  char text[12];
  std::snprintf(text, sizeof text, "%02X%02X %02X%02X", answer.data[7], answer.data[6], answer.data[5], answer.data[4]);
  return text;
}

std::string count(Bench& device, std::uint16_t index, std::uint32_t value) { return write(device, index, 0, value, 1); }
std::string map(Bench& device, std::uint16_t index, std::uint8_t entry, std::uint32_t value) {
  return write(device, index, entry, value, 4);
}
std::string cob_id(Bench& device, std::uint16_t index, std::uint32_t value) {
  return write(device, index, 1, value, 4);
}

/// Maps these objects to TPDO4 or RPDO3, which are empty and invalid by default.
std::string remap(Bench& device, std::uint16_t mapping, const std::vector<std::uint32_t>& objects) {
  std::string answer = count(device, mapping, 0);
  std::uint8_t entry = 0;
  for (const std::uint32_t object : objects) {
    if (answer == "ok") answer = map(device, mapping, ++entry, object);
  }
  return answer == "ok" ? count(device, mapping, entry) : answer;
}

// How a mapping is stored: 12 bits hold an offset up to FFEh; FFFh means "nothing".

namespace entry = canopen::entry;

template <entry::Word Word>
struct DeviceOf {
  static constexpr std::uint32_t dummies = 0;
  static constexpr canopen::Run runs[] = {{0x2000, 0}, {0xFFFF, 1}};
  static constexpr entry::Word entries[] = {Word};
  static constexpr canopen::Dictionary dictionary{.runs = runs,
                                                  .entries = entries,
                                                  .shapes = {},
                                                  .subs = {},
                                                  .limits = {},
                                                  .wide_limits = {},
                                                  .constants = nullptr};
};
template <entry::Word Word>
constexpr std::size_t bytes_of_a_run = sizeof(typename canopen::MappedRun<DeviceOf<Word>>::Word);

static_assert(bytes_of_a_run<entry::ram | entry::u8 | entry::rw | entry::tpdo | 0xFFE> == 2);
static_assert(bytes_of_a_run<entry::ram | entry::u8 | entry::rw | entry::tpdo | 0xFFF> == 4);
static_assert(bytes_of_a_run<entry::rom | entry::u8 | entry::ro | entry::tpdo | 0xFFF> == 4);
static_assert(bytes_of_a_run<entry::ram | entry::u8 | entry::rw | entry::rpdo | 0x1000> == 4);
static_assert(bytes_of_a_run<entry::ram | entry::u8 | entry::rw | 0xFFF> == 2, "no PDO carries it");
static_assert(bytes_of_a_run<entry::immediate | entry::u16 | entry::ro | entry::tpdo | 0xFFF> == 2, "its value");
static_assert(bytes_of_a_run<entry::ram | entry::boolean | entry::rw | entry::rpdo> == 4, "its length is in bits");

TEST(DynamicMapping, TakesEffectWhenThePdoIsCreated) {
  Bench device;
  device.ask(bench::start);
  device.node.set<od::byte>(0x5A);
  EXPECT_EQ(device.node.set<od::signed_24_bits>(-2), canopen::ok);
  device.node.set<od::input_word>(0x1234);
  device.pass(0s);
  EXPECT_EQ(remap(device, 0x1A03, {0x20060010, 0x20030018, 0x20000008}), "ok");
  EXPECT_EQ(cob_id(device, 0x1803, 0x40000333), "ok");
  device.node.set<od::byte>(0x5B);
  EXPECT_EQ(device.pass(0s), "333 34 12 FE FF FF 5B");
}

TEST(DynamicMapping, FollowsTheFiveStepsOnAValidPdo) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(cob_id(device, 0x1800, 0x80000185), "ok");
  EXPECT_EQ(remap(device, 0x1A00, {0x20000008}), "ok");
  EXPECT_EQ(cob_id(device, 0x1800, 0x00000185), "ok");
  device.node.set<od::byte>(1);
  EXPECT_EQ(device.pass(0s), "185 01");
  device.node.set<od::input_word>(1);  // no longer mapped in TPDO1
  EXPECT_EQ(device.pass(0s), "");
}

TEST(DynamicMapping, ReceivesWhatItMaps) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(remap(device, 0x1602, {0x00050008, 0x20010010, 0x20030018}), "ok");
  EXPECT_EQ(cob_id(device, 0x1402, 0x222), "ok");
  device.ask("222 FF 34 12 FE FF FF");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x1234);
  EXPECT_EQ(device.node.get<od::signed_24_bits>(), -2);
}

TEST(DynamicMapping, PlacesBits) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(remap(device, 0x1A03, {0x20040101, 0x20040201, 0x20000008, 0x20040301}), "ok");
  EXPECT_EQ(remap(device, 0x1602, {0x00010001, 0x20040201, 0x20000008, 0x20040301}), "ok");
  EXPECT_EQ(cob_id(device, 0x1803, 0x333), "ok");
  EXPECT_EQ(cob_id(device, 0x1402, 0x222), "ok");
  EXPECT_EQ(device.ask("222 57 05"), "333 56 05");
  EXPECT_EQ(device.node.get<od::byte>(), 0x55);
  EXPECT_TRUE(device.node.get<od::switches<2>>());
  EXPECT_TRUE(device.node.get<od::switches<3>>());
  EXPECT_FALSE(device.node.get<od::switches<1>>());
}

TEST(DynamicMapping, LeavesAnObjectAloneWhoseEntryIsADummyNow) {
  Bench device;
  device.ask(bench::start);
  remap(device, 0x1602, {0x20010010});
  cob_id(device, 0x1402, 0x222);
  device.ask("222 11 11");
  cob_id(device, 0x1402, 0x80000222);
  EXPECT_EQ(remap(device, 0x1602, {0x00050008}), "ok");
  cob_id(device, 0x1402, 0x222);
  device.ask("222 22");
  EXPECT_EQ(device.node.get<od::output_word>(), 0x1111);
}

TEST(DynamicMapping, TakesAnyValueOfAByteAsABoolean) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(remap(device, 0x1602, {0x20040108}), "ok");
  cob_id(device, 0x1402, 0x222);
  device.ask("222 FE");
  EXPECT_EQ(device.ask("605 40 04 20 01 00 00 00 00"), "585 4F 04 20 01 01 00 00 00");
}

TEST(DynamicMapping, KeepsTheLimitsOfAnObject) {
  Bench device;
  device.ask(bench::start);
  remap(device, 0x1602, {0x20050008, 0x20000008});
  cob_id(device, 0x1402, 0x222);
  device.ask("222 65 01");
  EXPECT_EQ(device.node.get<od::percentage>(), 0);
  EXPECT_EQ(device.node.get<od::byte>(), 1);
  device.ask("222 64 02");
  EXPECT_EQ(device.node.get<od::percentage>(), 100);
}

TEST(DynamicMapping, AsksTheHandlerOfAnObject) {
  int calls = 0;
  auto device = bench::with<pdo_device::Device>(canopen::on_write<od::byte>([&](std::uint8_t value) {
    ++calls;
    return value == 7 ? canopen::AbortCode::invalid_value : canopen::ok;
  }));
  device.ask(bench::start);
  device.ask("605 23 02 16 01 08 00 00 20");
  device.ask("605 2F 02 16 00 01 00 00 00");
  device.ask("605 23 02 14 01 22 02 00 00");
  device.ask("222 06");
  device.ask("222 07");
  EXPECT_EQ(device.node.get<od::byte>(), 6);
  EXPECT_EQ(calls, 2);
}

TEST(DynamicMapping, SendsOnWhatAnRpdoBrings) {
  Bench device;
  device.ask(bench::start);
  remap(device, 0x1602, {0x20080040});
  cob_id(device, 0x1402, 0x222);
  remap(device, 0x1A03, {0x20080040});  // now a TPDO maps it, too
  cob_id(device, 0x1803, 0x333);
  EXPECT_EQ(device.ask("222 01 02 03 04 05 06 07 08"), "333 01 02 03 04 05 06 07 08");
  EXPECT_EQ(device.ask("222 01 02 03 04 05 06 07 08"), "");
}

TEST(DynamicMapping, CarriesConstants) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(remap(device, 0x1A03, {0x20070020}), "ok");
  cob_id(device, 0x1803, 0x333);
  EXPECT_EQ(device.ask("333 R 4"), "333 78 56 34 12");
}

TEST(DynamicMapping, IsRestoredByAReset) {
  Bench device;
  cob_id(device, 0x1800, 0x80000185);
  remap(device, 0x1A00, {0x20000008});
  EXPECT_EQ(device.ask("605 40 00 1A 01 00 00 00 00"), "585 43 00 1A 01 08 00 00 20");
  device.ask(bench::reset_communication);
  EXPECT_EQ(device.ask("605 40 00 1A 01 00 00 00 00"), "585 43 00 1A 01 10 00 06 20");
  EXPECT_EQ(device.ask(bench::start), "185 00 00 00 00 00 00");
}

TEST(DynamicMapping, OfNothingIsSentNever) {
  Bench device;
  device.ask(bench::start);
  EXPECT_EQ(cob_id(device, 0x1803, 0x333), "ok");
  EXPECT_EQ(device.ask("333 R 0"), "");
  EXPECT_EQ(device.pass(10s), "");
}

// Rejected mappings

TEST(DynamicMappingRefuses, AnyWriteWhileThePdoIsValid) {
  Bench device;
  EXPECT_EQ(count(device, 0x1A00, 0), "0601 0000");
  EXPECT_EQ(map(device, 0x1A00, 1, 0x20000008), "0601 0000");
  EXPECT_EQ(count(device, 0x1600, 0), "0601 0000");
}

TEST(DynamicMappingRefuses, AnEntryWhileSubIndex0IsNot0) {
  Bench device;
  remap(device, 0x1A03, {0x20000008});
  EXPECT_EQ(map(device, 0x1A03, 2, 0x20000008), "0601 0000");
}

TEST(DynamicMappingRefuses, AnObjectThatDoesNotExist) {
  Bench device;
  EXPECT_EQ(map(device, 0x1A03, 1, 0x30000008), "0604 0041");
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20000108), "0604 0041");
}

TEST(DynamicMappingRefuses, AnObjectThatCannotBeMapped) {
  Bench device;
  EXPECT_EQ(map(device, 0x1A03, 1, 0x200A0010), "0604 0041");  // PDOMapping=0
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20010010), "0604 0041");  // rww in a TPDO
  EXPECT_EQ(map(device, 0x1602, 1, 0x20060010), "0604 0041");  // ro in an RPDO
  EXPECT_EQ(map(device, 0x1602, 1, 0x20070020), "0604 0041");  // const in an RPDO
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20090018), "0604 0041");  // a string
}

TEST(DynamicMappingRefuses, AWrongLength) {
  Bench device;
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20060008), "0604 0041");
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20060020), "0604 0041");
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20060000), "0604 0041");
}

TEST(DynamicMappingRefuses, DummiesThatAreNotAllowed) {
  Bench device;
  EXPECT_EQ(map(device, 0x1A03, 1, 0x00050008), "0604 0041");  // none in a TPDO
  EXPECT_EQ(map(device, 0x1602, 1, 0x00020008), "0604 0041");  // Dummy0002=0
  EXPECT_EQ(map(device, 0x1602, 1, 0x00050010), "0604 0041");  // not 16 bits
  EXPECT_EQ(map(device, 0x1602, 1, 0x00050108), "0604 0041");  // no sub-index
  EXPECT_EQ(map(device, 0x1602, 1, 0x00050008), "ok");
}

TEST(DynamicMappingRefuses, MoreThan64Bits) {
  Bench device;
  EXPECT_EQ(remap(device, 0x1A03, {0x20080040, 0x20040101}), "0604 0042");
  EXPECT_EQ(remap(device, 0x1A03, {0x20080040}), "ok");
}

TEST(DynamicMappingRefuses, MoreObjectsThanThereIsRoomFor) {
  Bench device;
  EXPECT_EQ(count(device, 0x1A03, 9), "0604 0042");
  EXPECT_EQ(count(device, 0x1A03, 254), "0604 0042");
  EXPECT_EQ(count(device, 0x1A03, 255), "0604 0042");
}

TEST(DynamicMappingRefuses, AnEntryThatMapsNothing) {
  Bench device;
  EXPECT_EQ(map(device, 0x1A03, 1, 0x20000008), "ok");
  EXPECT_EQ(map(device, 0x1A03, 3, 0x20000008), "ok");
  EXPECT_EQ(count(device, 0x1A03, 3), "0604 0042");
  EXPECT_EQ(map(device, 0x1A03, 1, 0), "ok");  // an entry may be cleared
}

TEST(DynamicMappingRefuses, Subindex4OfTheCommunicationParameter) {
  Bench device;
  EXPECT_EQ(write(device, 0x1800, 4, 0, 1), "0609 0011");
  EXPECT_EQ(device.ask("605 40 00 18 04 00 00 00 00"), "585 80 00 18 04 11 00 09 06");
}

TEST(CobIdOfAPdo, MayNotChangeWhileThePdoIsValid) {
  Bench device;
  EXPECT_EQ(cob_id(device, 0x1800, 0x00000186), "0609 0030");
  EXPECT_EQ(cob_id(device, 0x1800, 0x80000186), "ok");
  EXPECT_EQ(cob_id(device, 0x1800, 0x00000187), "ok");
}

TEST(CobIdOfAPdo, IsNoRestrictedOne) {
  Bench device;
  cob_id(device, 0x1800, 0x80000185);
  for (const std::uint32_t id : {0x000u, 0x001u, 0x07Fu, 0x101u, 0x180u, 0x581u, 0x5FFu, 0x601u, 0x67Fu, 0x6E0u, 0x6FFu,
                                 0x701u, 0x77Fu, 0x780u, 0x7FFu}) {
    EXPECT_EQ(cob_id(device, 0x1800, id), "0609 0030") << std::hex << id;
  }
  EXPECT_EQ(cob_id(device, 0x1800, 0x181), "ok");
}

// The same EDS with static mapping

TEST(StaticMapping, IsReadOnly) {
  bench::Bench<static_pdo_device::Device> device;
  EXPECT_EQ(device.ask("605 40 00 1A 01 00 00 00 00"), "585 43 00 1A 01 10 00 06 20");
  device.ask("605 23 00 18 01 85 01 00 80");
  EXPECT_EQ(device.ask("605 2F 00 1A 00 00 00 00 00"), "585 80 00 1A 00 02 00 01 06");
}

}  // namespace
