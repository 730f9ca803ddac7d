/// The format of mapping parameters and the places of mapped objects (CiA 301, 7.5.2.36 and 7.5.2.38).
#include "pdo/mapping.hpp"

#include <gtest/gtest.h>

#include <map>

namespace edsc {
namespace {

/// 6041h:00 with 16 bits: index, sub-index and length from the high byte to the low byte.
constexpr std::uint32_t statusword = 0x6041'0010;

TEST(MappingValue, HasIndexSubIndexAndLengthFromTheHighByteToTheLowByte) {
  const MappingValue mapped = MappingValue::of(statusword);
  EXPECT_EQ(mapped.index, 0x6041);
  EXPECT_EQ(mapped.sub_index, 0x00);
  EXPECT_EQ(mapped.bits, 16);
  EXPECT_EQ(mapped, (MappingValue{0x6041, 0, 16}));
  EXPECT_EQ(mapped.value(), statusword);
  EXPECT_EQ(MappingValue::of(0x2010'FF01), (MappingValue{0x2010, 0xFF, 1}));
  EXPECT_EQ((MappingValue{0xFFFF, 0xFE, 0xFF}).value(), 0xFFFF'FEFFU);
}

TEST(MappingValue, IsEmptyOnlyIfAllBitsAreZero) {
  EXPECT_TRUE(MappingValue::of(0).is_empty());
  EXPECT_FALSE(MappingValue::of(0x0000'0008).is_empty());
}

TEST(MappingValue, IsADummyIfItsIndexIsOneOfADataType) {
  const MappingValue unsigned8 = MappingValue::of(0x0005'0008);
  EXPECT_TRUE(unsigned8.is_dummy());
  ASSERT_NE(unsigned8.dummy_type(), nullptr);
  EXPECT_EQ(unsigned8.dummy_type()->name, "UNSIGNED8");
  EXPECT_TRUE(MappingValue::of(0x001F'0008).is_dummy());
  EXPECT_EQ(MappingValue::of(0x001F'0008).dummy_type(), nullptr) << "CiA 301 reserves the data type 1Fh";
  EXPECT_FALSE(MappingValue::of(0x0020'0008).is_dummy());
  EXPECT_EQ(MappingValue::of(statusword).dummy_type(), nullptr);
}

TEST(MappingValue, IsAMultipleOfTheGranularity) {
  EXPECT_TRUE(MappingValue::of(statusword).is_multiple_of(8));
  EXPECT_FALSE(MappingValue::of(0x2000'000C).is_multiple_of(8));
  EXPECT_TRUE(MappingValue::of(0x2000'0001).is_multiple_of(1));
}

TEST(Mapping, PlacesEachObjectAfterTheOneBefore) {
  const std::vector<MappingValue> objects{{0x2002, 0, 1}, {0x6041, 0, 16}, {0x6064, 0, 32}};
  const std::vector<PlacedObject> mapping = placed(objects);
  ASSERT_EQ(mapping.size(), 3U);
  EXPECT_EQ(mapping[0].offset, 0);
  EXPECT_EQ(mapping[1].offset, 1);
  EXPECT_EQ(mapping[2].offset, 17);
  EXPECT_EQ(mapping[2].end(), 49U);
  EXPECT_EQ(mapping[2].position, 3);
  EXPECT_EQ(total_bits(mapping), 49U);
  EXPECT_EQ(total_bits(objects), 49U);
}

TEST(Mapping, HasNoPlaceForAnEmptyEntry) {
  const std::map<std::uint8_t, std::uint32_t> values{{1, 0x2000'0008}, {2, 0}, {4, 0x2001'0110}, {5, 0x2002'0008}};
  const auto value_of = [&](std::uint8_t sub_index) {
    const auto at = values.find(sub_index);
    return at == values.end() ? 0 : at->second;
  };
  const std::vector<PlacedObject> mapping = read_mapping(4, value_of);
  ASSERT_EQ(mapping.size(), 2U) << "sub-index 2 is 0, sub-index 3 does not exist, and 5 is not counted";
  EXPECT_EQ(mapping[0].position, 1);
  EXPECT_EQ(mapping[1].position, 4);
  EXPECT_EQ(mapping[1].sub_index, 1);
  EXPECT_EQ(mapping[1].offset, 8);
  EXPECT_TRUE(read_mapping(0, value_of).empty());
}

TEST(Mapping, OfClassicalCanHasUpTo64Bits) {
  EXPECT_EQ(classical_can.bits(), 64U);
  const std::vector<MappingValue> objects{{0x2000, 0, 32}, {0x2001, 0, 32}, {0x2002, 0, 1}};
  const std::vector<PlacedObject> mapping = placed(objects);
  EXPECT_TRUE(mapping[1].is_within(classical_can));
  EXPECT_FALSE(mapping[2].is_within(classical_can));
}

TEST(Mapping, HasManyLongObjectsWithoutOverflow) {
  constexpr std::size_t most = 253;
  const std::vector<MappingValue> objects(most, {0x2000, 0, 255});
  EXPECT_EQ(placed(objects).back().offset, 252 * 255);
  EXPECT_EQ(placed(objects).back().end(), 253U * 255U);
}

TEST(PlacedObject, HasTheBitsOfAnotherOnlyWithTheSameBeginAndLength) {
  const PlacedObject one{{0x2000, 0, 16}, 1, 8};
  EXPECT_TRUE(one.has_bits_of({{0x3000, 1, 16}, 2, 8}));
  EXPECT_FALSE(one.has_bits_of({{0x2000, 0, 16}, 1, 0}));
  EXPECT_FALSE(one.has_bits_of({{0x2000, 0, 8}, 1, 8}));
}

TEST(PdoParameters, AreThoseOfTables) {
  const auto is = [](PdoDirection direction, std::uint16_t number, std::uint16_t communication, std::uint16_t mapping) {
    const PdoParameterIndices indices = parameters_of(direction, number);
    EXPECT_EQ(indices.communication, communication);
    EXPECT_EQ(indices.mapping, mapping);
    EXPECT_EQ(mapping_parameter_of(communication), mapping);
  };
  is(PdoDirection::receive, 1, 0x1400, 0x1600);
  is(PdoDirection::receive, classical_can.pdos, 0x15FF, 0x17FF);
  is(PdoDirection::transmit, 1, 0x1800, 0x1A00);
  is(PdoDirection::transmit, classical_can.pdos, 0x19FF, 0x1BFF);
}

TEST(Multiplexing, IsStatedBy254And255MappedObjects) {
  EXPECT_FALSE(is_multiplexed(0));
  EXPECT_FALSE(is_multiplexed(64));
  EXPECT_FALSE(is_multiplexed(253));
  EXPECT_TRUE(is_multiplexed(254));
  EXPECT_TRUE(is_multiplexed(255));
}

}  // namespace
}  // namespace edsc
