#include "device/meaning/raw_unit.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace edsc {
namespace {

Quantity quantity(std::string_view unit, std::string_view scale = "1", std::string_view offset = "0") {
  Quantity result;
  result.unit = canopen::find_unit(unit);
  result.symbol = unit;
  result.scale = parse_rational(scale).value();
  result.offset = parse_rational(offset).value();
  return result;
}

TEST(RawUnit, IsTheUnitWithItsScaleAndOffset) {
  EXPECT_EQ(raw_unit_text(quantity("rpm")), "rpm");
  EXPECT_EQ(raw_unit_text(quantity("V", "1/10")), "0.1 V");
  EXPECT_EQ(raw_unit_text(quantity("V", "1/2", "-40")), "0.5 V, 0 is -40 V");
  EXPECT_EQ(raw_unit_text(quantity("K", "1", "200")), "K, 0 is 200 K");
  EXPECT_EQ(raw_unit_text(quantity("", "1/10")), "0.1");
  EXPECT_EQ(raw_unit_text(quantity("")), "");
}

TEST(RawUnit, IsTheSameIfRawNumbersAreTheSameValues) {
  EXPECT_TRUE(has_same_raw_numbers(quantity("ms"), quantity("s", "1/1000")));
  EXPECT_TRUE(has_same_raw_numbers(quantity("degC"), quantity("K", "1", "273.15")));
  EXPECT_TRUE(has_same_raw_numbers(quantity("furlong"), quantity("furlong")));
}

TEST(RawUnit, IsAnotherForAnotherScaleOffsetOrDimension) {
  EXPECT_FALSE(has_same_raw_numbers(quantity("V"), quantity("V", "1/10")));
  EXPECT_FALSE(has_same_raw_numbers(quantity("V"), quantity("V", "1", "1")));
  EXPECT_FALSE(has_same_raw_numbers(quantity("degC"), quantity("K")));
  EXPECT_FALSE(has_same_raw_numbers(quantity("V"), quantity("A")));
  EXPECT_FALSE(has_same_raw_numbers(quantity("furlong"), quantity("m")));
}

}  // namespace
}  // namespace edsc
