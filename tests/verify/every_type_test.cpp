/// The generated device of every_type.eds: its tables and its typed objects agree with the EDS.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <canopen/node.hpp>
#include <canopen/od/object_store.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <every_type/description.hpp>
#include <every_type/device.hpp>
#include <limits>
#include <string>
#include <vector>

#include "every_type_values.hpp"

namespace {

using canopen::AbortCode;
using canopen::NodeId;
using every_type_test::expected_values;
using every_type_test::ExpectedValue;
using Store = canopen::ObjectStore<every_type::Device>;
using Bytes = std::vector<std::uint8_t>;
namespace od = every_type::od;

struct Device {
  explicit Device(std::uint8_t node_id = 5) {
    store.reset_application(NodeId{node_id});
    store.reset_communication(NodeId{node_id});
  }

  Bytes read(std::uint16_t index, std::uint8_t sub_index) {
    std::array<std::uint8_t, 8> scratch{};
    const auto bytes = store.entries().read(every_type::dictionary.find(index, sub_index), scratch);
    return {bytes.begin(), bytes.end()};
  }

  AbortCode check(std::uint16_t index, std::uint8_t sub_index, const Bytes& bytes) {
    return store.entries().check(index, sub_index, every_type::dictionary.find(index, sub_index), bytes);
  }

  Store store;
};

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, text.empty() ? "%02X" : " %02X", static_cast<unsigned>(byte));
    text += digits;
  }
  return text;
}

std::string label(std::uint16_t index, std::uint8_t sub_index) {
  char text[16];
  std::snprintf(text, sizeof text, "%04Xh:%02X", static_cast<unsigned>(index), static_cast<unsigned>(sub_index));
  return text;
}

/// A number of up to 64 bits as it is sent, little-endian.
Bytes wire(std::int64_t number, std::size_t size) {
  Bytes bytes;
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  return bytes;
}
Bytes wire(float number) { return wire(std::bit_cast<std::int32_t>(number), 4); }
Bytes wire(double number) { return wire(std::bit_cast<std::int64_t>(number), 8); }

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
  device.store.set<od::cob_id_sync>(0x81);
  device.store.set<od::integer24_array<2>>(1);
  device.store.reset_application(NodeId{5});
  device.store.reset_communication(NodeId{5});
  EXPECT_EQ(device.store.get<od::integer32_value>(), -100000);
  EXPECT_EQ(device.store.get<od::cob_id_sync>(), 0x80U);
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

// ---- limits ----

struct LimitRow {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::vector<Bytes> fine;
  std::vector<Bytes> too_low;
  std::vector<Bytes> too_high;
};

TEST(Limits, AreEnforced) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const LimitRow rows[] = {
      {0x2700, 0, {wire(0x100000000, 8), wire(-2, 8)}, {wire(0xFFFFFFFF, 8), wire(0, 8)}, {wire(-1, 8)}},
      {0x2701, 0, {wire(-INT64_MAX, 8), wire(0, 8), wire(5000000000, 8)}, {wire(INT64_MIN, 8)}, {wire(5000000001, 8)}},
      {0x2702, 0, {wire(-1.5F), wire(0.F), wire(-0.F), wire(2.5F)}, {wire(-1.6F)}, {wire(2.6F), wire(1e30F)}},
      {0x2703, 0, {wire(-1e100), wire(-1.0)}, {wire(-1e101), wire(-infinity)}, {wire(-0.9), wire(0.0), wire(infinity)}},
      {0x2704, 0, {wire(-3, 4), wire(INT32_MAX, 4)}, {wire(-4, 4), wire(INT32_MIN, 4)}, {}},
      {0x2705, 0, {wire(-10, 2), wire(INT16_MIN, 2)}, {}, {wire(-9, 2), wire(0, 2), wire(INT16_MAX, 2)}},
      {0x2706, 0, {wire(-5, 3), wire(70000, 3)}, {wire(-6, 3), wire(-8388608, 3)}, {wire(70001, 3)}},
      {0x2707, 0, {wire(1, 5), wire(0xFF00000000, 5)}, {wire(0, 5)}, {wire(0xFF00000001, 5)}},
      {0x2708, 0, {wire(-3, 7), wire(-1, 7)}, {wire(-4, 7)}, {wire(0, 7), wire(1, 7)}},
      {0x2709, 0, {wire(-128, 1), wire(127, 1)}, {}, {}},
      {0x270A, 1, {wire(-2, 1), wire(3, 1)}, {wire(-3, 1)}, {wire(4, 1)}},
      {0x270A, 3, {wire(-2, 1), wire(3, 1)}, {wire(-3, 1)}, {wire(4, 1)}},
      {0x270B, 1, {wire(1, 1), wire(3, 1)}, {wire(0, 1)}, {wire(4, 1)}},
      {0x270B, 2, {wire(0, 8), wire(0xFF00000000, 8)}, {}, {wire(0xFF00000001, 8), wire(-1, 8)}},
      {0x2404, 3, {wire(-10, 2), wire(10, 2)}, {wire(-11, 2)}, {wire(11, 2)}},
      {0x2002, 0, {wire(-100, 1), wire(100, 1)}, {wire(-101, 1)}, {wire(101, 1)}},
      {0x2005, 0, {wire(0x10, 1), wire(0xF0, 1)}, {wire(0xF, 1)}, {wire(0xF1, 1)}},
      {0x2007, 0, {wire(1, 4), wire(4000000000, 4)}, {wire(0, 4)}, {wire(4000000001, 4)}},
      {0x1003, 0, {wire(0, 1)}, {}, {wire(1, 1)}},
  };
  Device device;
  for (const LimitRow& row : rows) {
    const std::string where = label(row.index, row.sub_index);
    for (const Bytes& bytes : row.fine)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), canopen::ok) << where << " " << hex(bytes);
    for (const Bytes& bytes : row.too_low)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), AbortCode::value_too_low) << where << " " << hex(bytes);
    for (const Bytes& bytes : row.too_high)
      EXPECT_EQ(device.check(row.index, row.sub_index, bytes), AbortCode::value_too_high) << where << " " << hex(bytes);
  }
}

TEST(Limits, RefuseWhatIsNoNumber) {
  Device device;
  EXPECT_EQ(device.check(0x2702, 0, wire(std::numeric_limits<float>::quiet_NaN())), AbortCode::invalid_value);
  EXPECT_EQ(device.check(0x2703, 0, wire(std::numeric_limits<double>::quiet_NaN())), AbortCode::invalid_value);
  EXPECT_EQ(device.check(0x2001, 0, {2}), AbortCode::invalid_value);
}

TEST(Limits, OfAStringAreItsCapacity) {
  Device device;
  EXPECT_EQ(device.check(0x2500, 0, Bytes(16, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2500, 0, Bytes(17, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2009, 0, Bytes(5, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2009, 0, Bytes(6, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2209, 3, Bytes(27, 'x')), canopen::ok);
  EXPECT_EQ(device.check(0x2209, 3, Bytes(28, 'x')), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x2403, 2, Bytes(17, 'x')), AbortCode::length_too_high);
  static_assert(every_type::Device::longest_download == 27);
}

TEST(Limits, OfLengthAreThoseOfTheType) {
  Device device;
  EXPECT_EQ(device.check(0x2010, 0, wire(0, 2)), AbortCode::length_too_low);
  EXPECT_EQ(device.check(0x2010, 0, wire(0, 4)), AbortCode::length_too_high);
  EXPECT_EQ(device.check(0x200C, 0, Bytes(6, 0)), canopen::ok);
  EXPECT_EQ(device.check(0x200C, 0, Bytes(5, 0)), AbortCode::length_too_low);
}

// ---- node-ID formulas ----

TEST(NodeIdFormulas, FollowTheNodeId) {
  for (const unsigned node_id : {1u, 5u, 127u}) {
    Device device{static_cast<std::uint8_t>(node_id)};
    EXPECT_EQ(device.store.get<od::cob_id_emcy>(), 0x80U + node_id);
    EXPECT_EQ(device.store.get<od::rpdo_1_communication_parameter::cob_id>(), 0x200U + node_id);
    EXPECT_EQ(device.store.get<od::tpdo_2_communication_parameter::cob_id>(), 0xC0000280U + node_id);
    EXPECT_EQ(device.store.get<od::sdo_server_parameter::cob_id_client_to_server>(), 0x600U + node_id);
    EXPECT_EQ(device.store.get<od::unsigned64_formula>(), 0x1000000000U + node_id);
    EXPECT_EQ(device.store.get<od::constant_integer32_formula>(), 10 + static_cast<std::int32_t>(node_id));
  }
}

struct SilentBus {
  static bool send(const canopen::Frame&) { return true; }
};

TEST(NodeIdFormulas, OfTheApplicationFollowTheNodeIdFromPowerOnOn) {
  SilentBus bus;
  auto node = canopen::make_node<every_type::Device>(bus, NodeId{9});
  node.start(canopen::TimePoint{});
  EXPECT_EQ(node.get<od::node_id_itself>(), 9);
  EXPECT_EQ(node.get<od::integer16_formula>(), -256 + 9);
  EXPECT_EQ(node.get<od::array_with_formulas<1>>(), 0x10U + 9);
  EXPECT_EQ(node.get<od::array_with_formulas<2>>(), 0x20U);
  EXPECT_EQ(node.get<od::record_with_formulas::word>(), 2 + 9);
}

// ---- domains ----

TEST(Domains, AreUnboundUntilTheApplicationSaysWhere) {
  Device device;
  std::array<std::uint8_t, 8> scratch{};
  const auto word = every_type::dictionary.find(0x200F, 0);
  EXPECT_EQ(device.store.entries().read(word, scratch).data(), nullptr);

  std::array<std::uint8_t, 4> memory{1, 2, 3, 4};
  device.store.values().application_cleared.domain_value = {memory.data(), 2, 4};
  EXPECT_EQ(hex(device.read(0x200F, 0)), "01 02");
  EXPECT_EQ(device.check(0x200F, 0, Bytes(4, 0)), canopen::ok);
  EXPECT_EQ(device.check(0x200F, 0, Bytes(5, 0)), AbortCode::length_too_high);
}

}  // namespace
