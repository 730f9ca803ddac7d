#include "eds/number.hpp"

#include <gtest/gtest.h>

namespace edsc {
namespace {

TEST(ParseUnsigned, ReadsDecimalHexadecimalAndOctal) {
  EXPECT_EQ(parse_unsigned("0"), 0U);
  EXPECT_EQ(parse_unsigned("1536"), 1536U);
  EXPECT_EQ(parse_unsigned("0x1A00"), 0x1A00U);
  EXPECT_EQ(parse_unsigned("0X1a00"), 0x1A00U);
  EXPECT_EQ(parse_unsigned("017"), 15U);
  EXPECT_EQ(parse_unsigned("000"), 0U);
}

TEST(ParseUnsigned, TakesNoDecimalDigitForAnOctalOne) {
  EXPECT_EQ(parse_unsigned("008"), std::nullopt);
  EXPECT_EQ(parse_unsigned("009"), std::nullopt);
}

TEST(ParseDecimal, TakesLeadingZerosForPartOfTheNumber) {
  EXPECT_EQ(parse_decimal("08"), 8U);
  EXPECT_EQ(parse_decimal(" 010"), 10U);
  EXPECT_EQ(parse_decimal("000"), 0U);
  EXPECT_EQ(parse_decimal("0x10"), 16U);
  EXPECT_EQ(parse_decimal("1.0"), std::nullopt);
}

TEST(ParseUnsigned, CutsBlanksAndAPlus) {
  EXPECT_EQ(parse_unsigned(" \t12 "), 12U);
  EXPECT_EQ(parse_unsigned("+12"), 12U);
  EXPECT_EQ(parse_unsigned("+ 12"), std::nullopt);
}

TEST(ParseUnsigned, WantsTheWholeText) {
  for (const std::string_view text : {"", " ", "+", "-1", "0x", "12h", "0x12 0x13", "1.0", "12;", "$NODEID", "0x-1"}) {
    EXPECT_EQ(parse_unsigned(text), std::nullopt) << text;
  }
}

TEST(ParseUnsigned, HoldsSixtyFourBits) {
  EXPECT_EQ(parse_unsigned("0xFFFFFFFFFFFFFFFF"), 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(parse_unsigned("18446744073709551615"), 18446744073709551615U);
  EXPECT_EQ(parse_unsigned("18446744073709551616"), std::nullopt);
  EXPECT_EQ(parse_unsigned("0x10000000000000000"), std::nullopt);
}

TEST(ParseHex, ReadsDigitsWithoutPrefix) {
  EXPECT_EQ(parse_hex("1a00", 4), 0x1A00U);
  EXPECT_EQ(parse_hex("F", 2), 0xFU);
  EXPECT_EQ(parse_hex("100", 2), std::nullopt);
  EXPECT_EQ(parse_hex("0x1", 4), std::nullopt);
  EXPECT_EQ(parse_hex("", 4), std::nullopt);
}

TEST(StripInlineComment, CutsFromTheFirstMarkOn) {
  EXPECT_EQ(strip_inline_comment("0x1000 ; device type"), "0x1000");
  EXPECT_EQ(strip_inline_comment("7 # VAR # again"), "7");
  EXPECT_EQ(strip_inline_comment("7;"), "7");
  EXPECT_EQ(strip_inline_comment("  rw  "), "rw");
  EXPECT_EQ(strip_inline_comment("; nothing"), "");
}

}  // namespace
}  // namespace edsc
