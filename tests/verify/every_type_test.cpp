/// The generated device of every_type.eds: its default values and its typed objects agree with the EDS.
#include <gtest/gtest.h>

#include <canopen/node.hpp>
#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <every_type/description.hpp>
#include <every_type/device.hpp>
#include <limits>
#include <string>
#include <vector>

#include "every_type_bench.hpp"
#include "every_type_values.hpp"

namespace {

using canopen::NodeId;
using every_type_test::Device;
using every_type_test::expected_values;
using every_type_test::ExpectedValue;
using every_type_test::hex;
using every_type_test::label;
using every_type_test::wire;
namespace od = every_type::od;
using Store = canopen::ObjectStore<every_type::Device>;
using Bytes = std::vector<std::uint8_t>;

// ---- default values ----

TEST(EveryType, ReadsAsItsDefaultAfterAReset) {
  Device device;
  for (const ExpectedValue& expected : expected_values) {
    ASSERT_TRUE(every_type::dictionary.has(expected.index, expected.sub_index))
        << label(expected.index, expected.sub_index);
    EXPECT_EQ(hex(device.read(expected.index, expected.sub_index)), expected.bytes)
        << label(expected.index, expected.sub_index);
  }
}

TEST(EveryType, HasAnExpectedValueForEachEntryAndNoMore) {
  ASSERT_EQ(std::size(every_type::descriptions), std::size(expected_values));
  for (std::size_t i = 0; i < std::size(expected_values); ++i) {
    EXPECT_EQ(every_type::descriptions[i].index, expected_values[i].index);
    EXPECT_EQ(every_type::descriptions[i].sub_index, expected_values[i].sub_index);
  }
}

TEST(EveryType, HasNoOtherEntries) {
  std::size_t entries = 0;
  for (unsigned index = 0; index <= 0xFFFF; ++index) {
    if (every_type::dictionary.find(static_cast<std::uint16_t>(index), 0) == canopen::Dictionary::no_object) continue;
    for (unsigned sub_index = 0; sub_index <= 0xFF; ++sub_index) {
      entries +=
          every_type::dictionary.has(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub_index)) ? 1u : 0u;
    }
  }
  EXPECT_EQ(entries, std::size(expected_values));
}

TEST(EveryType, TakesItsDefaultsBackAtEachReset) {
  Device device;
  device.store.set<od::integer32_value>(1);
  device.store.set<od::cob_id_sync>(od::cob_id_sync::type{canopen::raw(0x81u)});
  device.store.set<od::integer24_array<2>>(1);
  device.store.reset_application(NodeId{5});
  device.store.reset_communication(NodeId{5});
  EXPECT_EQ(device.store.get<od::integer32_value>(), -100000);
  EXPECT_EQ(device.store.get<od::cob_id_sync>().raw(), 0x80U);
  EXPECT_EQ(device.store.get<od::integer24_array<2>>(), -1);
}

TEST(EveryType, DescribesEachEntry) {
  const auto* description = canopen::find_description(every_type::descriptions, 0x2201, 2);
  ASSERT_NE(description, nullptr);
  EXPECT_EQ(description->name(), "Element 2");
  EXPECT_EQ(description->object, "BOOLEAN array");
  EXPECT_EQ(description->type, canopen::DataType::boolean);
  EXPECT_EQ(canopen::find_description(every_type::descriptions, 0x2201, 4), nullptr);
}

// ---- typed access ----

/// Expects a typed read, then a typed write that the dictionary returns byte for byte.
template <class O>
void expect_round_trip(const typename O::type& before, const typename O::type& after, const Bytes& after_on_the_wire) {
  Device device;
  const std::string where = label(O::index, O::sub_index);
  EXPECT_EQ(device.store.get<O>(), before) << where;
  EXPECT_TRUE(device.store.set<O>(after)) << where << " has not changed";
  EXPECT_FALSE(device.store.set<O>(after)) << where << " has changed again";
  EXPECT_EQ(device.store.get<O>(), after) << where;
  EXPECT_EQ(hex(device.read(O::index, O::sub_index)), hex(after_on_the_wire)) << where;
}

TEST(TypedAccess, ReadsAndWritesABooleanAsOneByte) {
  expect_round_trip<od::boolean_value>(true, false, {0});
  expect_round_trip<od::boolean_array<2>>(false, true, {1});
  expect_round_trip<od::record_of_values::boolean_value>(true, false, {0});
}

TEST(TypedAccess, ReadsAndWritesIntegers) {
  expect_round_trip<od::integer8_value>(-5, 100, wire(100, 1));
  expect_round_trip<od::integer16_value>(-1000, -2, wire(-2, 2));
  expect_round_trip<od::integer24_value>(-8388608, 8388607, wire(8388607, 3));
  expect_round_trip<od::integer32_value>(-100000, -1, wire(-1, 4));
  expect_round_trip<od::integer40_value>(-2, -549755813888, wire(-549755813888, 5));
  expect_round_trip<od::integer48_value>(0x7FFFFFFFFFFF, -1, wire(-1, 6));
  expect_round_trip<od::integer56_value>(-36028797018963968, 1, wire(1, 7));
  expect_round_trip<od::integer64_value>(std::numeric_limits<std::int64_t>::min(), 3, wire(3, 8));
}

TEST(TypedAccess, ReadsAndWritesUnsigneds) {
  expect_round_trip<od::unsigned8_value>(0xC8, 0x10, wire(0x10, 1));
  expect_round_trip<od::unsigned16_value>(0xABCD, 1, wire(1, 2));
  expect_round_trip<od::unsigned24_value>(0x123456, 0xFFFFFF, wire(0xFFFFFF, 3));
  expect_round_trip<od::unsigned32_value>(4000000000, 1, wire(1, 4));
  expect_round_trip<od::unsigned40_value>(0x123456789A, 1, wire(1, 5));
  expect_round_trip<od::unsigned48_value>(0x123456789ABC, 1, wire(1, 6));
  expect_round_trip<od::unsigned56_value>(0x123456789ABCDE, 1, wire(1, 7));
  expect_round_trip<od::unsigned64_value>(~std::uint64_t{0}, 1, wire(1, 8));
}

// shows 000.25
TEST(TypedAccess, ReadsAndWritesReals) {
  expect_round_trip<od::real32_value>(-1.5F, 0.25F, wire(0.25F));
  expect_round_trip<od::real64_value>(0.1, -0.25, wire(-0.25));
}

TEST(TypedAccess, ReadsAndWritesTimes) {
  expect_round_trip<od::time_of_day_value>({43200000, 14000}, {1, 2}, {1, 0, 0, 0, 2, 0});
  expect_round_trip<od::time_difference_value>({1, 2}, {0x0FFFFFFF, 0xFFFF}, {0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF});
}

TEST(TypedAccess, ReachesEachElementOfAnArray) {
  expect_round_trip<od::integer16_array<1>>(-1000, 1, wire(1, 2));
  expect_round_trip<od::integer16_array<2>>(-32768, 1, wire(1, 2));
  expect_round_trip<od::integer16_array<3>>(7, 1, wire(1, 2));
  expect_round_trip<od::unsigned48_array<3>>(0xFFFFFFFFFFFF, 1, wire(1, 6));
  expect_round_trip<od::time_of_day_array<3>>({2, 1}, {3, 4}, {3, 0, 0, 0, 4, 0});
}

TEST(TypedAccess, ReachesEachMemberOfARecord) {
  expect_round_trip<od::record_of_values::integer8_value>(-5, 1, wire(1, 1));
  expect_round_trip<od::record_of_values::unsigned56_value>(0x123456789ABCDE, 1, wire(1, 7));
  expect_round_trip<od::record_of_values::real64_value>(0.1, 2.0, wire(2.0));
  expect_round_trip<od::record_with_gaps::far>(-2, 5, wire(5, 2));
}

TEST(TypedAccess, ReadsConstantsAndCannotSetThem) {
  Device device;
  EXPECT_EQ(device.store.get<od::integer24_constant>(), -8388608);
  EXPECT_EQ(device.store.get<od::unsigned64_constant>(), ~std::uint64_t{0});
  EXPECT_EQ(device.store.get<od::real64_constant>(), 0.1);
  EXPECT_EQ(device.store.get<od::integer32_constant_array<2>>(), -1);
  EXPECT_EQ(device.store.get<od::record_of_constants::visible_string_value>().view(), "hello");
  static_assert(!Store::settable<od::integer24_constant>());
  static_assert(!Store::settable<od::integer8_constant>());
  static_assert(!Store::settable<od::integer32_constant_array<2>>());
  static_assert(Store::settable<od::integer24_value>());
}

TEST(TypedAccess, ReadsAndWritesStrings) {
  Device device;
  EXPECT_EQ(device.store.get<od::visible_string_value>().view(), "hello");
  EXPECT_TRUE(device.store.set<od::text_without_default>("sixteen letters."));
  EXPECT_EQ(device.store.get<od::text_without_default>().view(), "sixteen letters.");
  EXPECT_EQ(hex(device.read(0x2500, 0)), "73 69 78 74 65 65 6E 20 6C 65 74 74 65 72 73 2E");
  EXPECT_TRUE(device.store.set<od::octets_without_default>({0, 1, 0}));
  EXPECT_EQ(hex(device.read(0x2505, 0)), "00 01 00");
}

TEST(TypedAccess, WritesWhatTheDictionaryReadsAndTheOtherWayRound) {
  Device device;
  const auto entries = device.store.entries();
  for (const ExpectedValue& expected : expected_values) {
    const auto word = every_type::dictionary.find(expected.index, expected.sub_index);
    if ((word & canopen::entry::writable) == 0 || canopen::entry::wire_bytes(word) == 0) continue;
    Bytes bytes(canopen::entry::wire_bytes(word), 0);
    bytes.front() = 1;
    entries.write(word, bytes);
    EXPECT_EQ(hex(device.read(expected.index, expected.sub_index)), hex(bytes))
        << label(expected.index, expected.sub_index);
  }
  EXPECT_EQ(device.store.get<od::integer56_value>(), 1);
  EXPECT_EQ(device.store.get<od::unsigned24_array<2>>(), 1U);
}

TEST(TypedAccess, ExtendsTheSignOfWhatTheDictionaryWrites) {
  Device device;
  const auto entries = device.store.entries();
  entries.write(every_type::dictionary.find(0x2010, 0), wire(-2, 3));
  entries.write(every_type::dictionary.find(0x2214, 3), wire(-3, 7));
  EXPECT_EQ(device.store.get<od::integer24_value>(), -2);
  EXPECT_EQ(device.store.get<od::integer56_array<3>>(), -3);
}

// ---- properties of the types ----

TEST(ObjectTypes, CarryAccessAndMapping) {
  using canopen::Access;
  using canopen::Mappable;
  static_assert(od::access_ro::access == Access::ro && od::access_ro::mappable == Mappable::tpdo);
  static_assert(od::access_wo::access == Access::wo && od::access_wo::mappable == Mappable::rpdo);
  static_assert(od::access_rw::access == Access::rw && od::access_rw::mappable == Mappable::both);
  static_assert(od::access_rww::access == Access::rww && od::access_rww::mappable == Mappable::rpdo);
  static_assert(od::access_rwr::access == Access::rwr && od::access_rwr::mappable == Mappable::tpdo);
  static_assert(od::access_const::access == Access::constant && od::access_const::mappable == Mappable::tpdo);
  static_assert(od::cob_id_sync::mappable == Mappable::no);
}

TEST(ObjectTypes, CarryTheirLengthOnTheWire) {
  static_assert(od::boolean_value::bits == 1);
  static_assert(od::integer24_value::bits == 24 && od::unsigned56_value::bits == 56);
  static_assert(od::time_of_day_value::bits == 48 && od::real64_value::bits == 64);
  static_assert(od::visible_string_value::bits == 0);
}

TEST(ObjectTypes, CarryTheirLimits) {
  static_assert(od::integer16_value::low_limit == -0x7FFF && od::integer16_value::high_limit == 0x7FFF);
  static_assert(od::unsigned64_limits::low_limit == 0x100000000);
  static_assert(od::integer64_limits::low_limit == -9223372036854775807);
  static_assert(od::real32_limits::low_limit == -1.5F && od::real32_limits::high_limit == 2.5F);
  static_assert(od::array_with_limits<3>::high_limit == 3);
  static_assert(canopen::low_limit<od::integer24_value>() == -8388608);
  static_assert(canopen::high_limit<od::high_limit_alone>() == -10);
  static_assert(canopen::low_limit<od::high_limit_alone>() == std::numeric_limits<std::int16_t>::min());
}

TEST(ObjectTypes, SayWhoMayReadAndWriteOverTheBus) {
  const auto rights = [](std::uint16_t index) {
    const auto word = every_type::dictionary.find(index, 0);
    return std::pair{(word & canopen::entry::readable) != 0, (word & canopen::entry::writable) != 0};
  };
  EXPECT_EQ(rights(0x2600), (std::pair{true, false}));  // ro
  EXPECT_EQ(rights(0x2601), (std::pair{false, true}));  // wo
  EXPECT_EQ(rights(0x2602), (std::pair{true, true}));   // rw
  EXPECT_EQ(rights(0x2603), (std::pair{true, true}));   // rww
  EXPECT_EQ(rights(0x2604), (std::pair{true, true}));   // rwr
  EXPECT_EQ(rights(0x2605), (std::pair{true, false}));  // const
}

TEST(ObjectTypes, MakeUpTheDefaultPdos) {
  static_assert(every_type::Rpdo1::bits == 40 && every_type::Tpdo1::bits == 41 && every_type::Tpdo2::bits == 64);
  static_assert(every_type::Rpdo1::maps<od::access_rww> && every_type::Tpdo1::maps<od::integer24_value>);
  const auto data = every_type::Tpdo1::pack(0x1234, true, -2);
  EXPECT_EQ(hex({data.begin(), data.end()}), "34 12 FD FF FF 01 00 00");
  EXPECT_EQ(every_type::Tpdo1::unpack(data), std::tuple(std::uint16_t{0x1234}, true, -2));
}

}  // namespace
