#include "values/value_bytes.hpp"

#include <gtest/gtest.h>

#include <array>

namespace edsc {
namespace {

using canopen::DataType;

const canopen::DataTypeRow& type_row(DataType type) {
  return *canopen::find_data_type(static_cast<std::uint32_t>(type));
}

TEST(ValueBytes, OfANumberHaveTheLengthOfItsTypeLowByteFirst) {
  Value value;
  value.bits = 0x0102'0304'0506'0708;
  EXPECT_EQ(bytes_of(value, type_row(DataType::unsigned24)), "\x08\x07\x06");
  EXPECT_EQ(bytes_of(value, type_row(DataType::unsigned64)), "\x08\x07\x06\x05\x04\x03\x02\x01");
  value.bits = 1;
  EXPECT_EQ(bytes_of(value, type_row(DataType::boolean)), "\x01");
}

TEST(ValueBytes, OfAUnicodeStringAreItsCodeUnits) {
  Value value;
  value.bytes = "a\xC3\xB6\xF0\x9F\x9A\x80";
  EXPECT_EQ(hex_pairs(bytes_of(value, type_row(DataType::unicode_string))), "6100F6003DD880DE");
  EXPECT_EQ(bytes_of(value, type_row(DataType::visible_string)), value.bytes);
}

TEST(ValueBytes, GiveTheNumberAgain) {
  EXPECT_EQ(number_of(std::array<std::uint8_t, 3>{0x08, 0x07, 0x06}), 0x060708U);
  EXPECT_EQ(number_of(std::array<std::uint8_t, 0>{}), 0U);
}

TEST(SignExtended, IsTheNumberOfATwosComplement) {
  EXPECT_EQ(sign_extended(0xFF, 8), -1);
  EXPECT_EQ(sign_extended(0x7F, 8), 127);
  EXPECT_EQ(sign_extended(0x80'0000, 24), -0x80'0000);
  EXPECT_EQ(sign_extended(~std::uint64_t{0}, 64), -1);
}

TEST(LowBits, AreAllFrom64On) {
  EXPECT_EQ(low_bits(1), 1U);
  EXPECT_EQ(low_bits(63), ~std::uint64_t{0} >> 1);
  EXPECT_EQ(low_bits(64), ~std::uint64_t{0});
}

}  // namespace
}  // namespace edsc
