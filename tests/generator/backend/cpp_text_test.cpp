#include "backend/cpp/cpp_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>

namespace edsc {
namespace {

using canopen::DataType;

const canopen::DataTypeRow& row(DataType type) { return *canopen::find_data_type(static_cast<std::uint32_t>(type)); }

std::string literal(DataType type, std::uint64_t bits, bool hexadecimal = false) {
  Value value;
  value.bits = bits;
  value.hexadecimal = hexadecimal;
  return cpp_literal(value, row(type));
}

std::string literal(DataType type, std::string bytes) {
  Value value;
  value.bytes = std::move(bytes);
  return cpp_literal(value, row(type));
}

std::string real(float value) { return literal(DataType::real32, std::bit_cast<std::uint32_t>(value)); }
std::string real(double value) { return literal(DataType::real64, std::bit_cast<std::uint64_t>(value)); }

TEST(CppLiteral, OfABooleanIsTrueOrFalse) {
  EXPECT_EQ(literal(DataType::boolean, 0), "false");
  EXPECT_EQ(literal(DataType::boolean, 1), "true");
}

TEST(CppLiteral, OfASignedIntegerIsDecimal) {
  EXPECT_EQ(literal(DataType::integer16, static_cast<std::uint64_t>(-5)), "-5");
  EXPECT_EQ(literal(DataType::integer64, static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())),
            "9223372036854775807");
  EXPECT_EQ(literal(DataType::integer32, static_cast<std::uint64_t>(std::int64_t{-2147483648})), "-2147483648");
}

TEST(CppLiteral, OfTheLowestInteger64IsNoNegatedLiteral) {
  EXPECT_EQ(literal(DataType::integer64, std::uint64_t{1} << 63), "std::numeric_limits<std::int64_t>::min()");
}

TEST(CppLiteral, OfAnUnsignedIntegerKeepsItsSpelling) {
  EXPECT_EQ(literal(DataType::unsigned32, 384), "384");
  EXPECT_EQ(literal(DataType::unsigned32, 384, true), "0x00000180");
  EXPECT_EQ(literal(DataType::unsigned8, 5, true), "0x05");
  EXPECT_EQ(literal(DataType::unsigned24, 5, true), "0x000005");
  EXPECT_EQ(literal(DataType::unsigned64, ~std::uint64_t{0}), "18446744073709551615u");
}

TEST(CppLiteral, OfARealIsTheShortestThatReadsTheSame) {
  EXPECT_EQ(real(1.0F), "1.0f");
  EXPECT_EQ(real(0.1F), "0.1f");
  EXPECT_EQ(real(0.1), "0.1");
  EXPECT_EQ(real(-2.0), "-2.0");
  EXPECT_EQ(real(-0.0F), "-0.0f");
  EXPECT_EQ(real(1e300), "1e+300");
}

TEST(CppLiteral, OfARealThatIsNoNumberIsNamed) {
  EXPECT_EQ(real(std::numeric_limits<float>::infinity()), "std::numeric_limits<float>::infinity()");
  EXPECT_EQ(real(-std::numeric_limits<double>::infinity()), "-std::numeric_limits<double>::infinity()");
  EXPECT_EQ(real(std::numeric_limits<float>::quiet_NaN()), "std::numeric_limits<float>::quiet_NaN()");
}

TEST(CppLiteral, OfATimeIsMillisecondsAndDays) {
  EXPECT_EQ(literal(DataType::time_of_day, (std::uint64_t{3} << 32) | 1000), "{1000, 3}");
}

TEST(CppLiteral, OfAVisibleStringIsQuoted) { EXPECT_EQ(literal(DataType::visible_string, "hello"), "\"hello\""); }

TEST(CppLiteral, OfAnOctetStringIsAListOfBytes) {
  EXPECT_EQ(literal(DataType::octet_string, std::string{"\x00\xFF", 2}), "{0x00, 0xFF}");
  EXPECT_EQ(literal(DataType::octet_string, ""), "{}");
}

TEST(CppLiteral, OfAUnicodeStringIsUtf16) {
  EXPECT_EQ(literal(DataType::unicode_string, "a"), "u\"a\"");
  EXPECT_EQ(literal(DataType::unicode_string,
                    "\xC3\xB6"
                    "a"),
            "u\"\\xF6\" u\"a\"")
      << "no digit behind is drawn in";
  EXPECT_EQ(literal(DataType::unicode_string, "\xF0\x9F\x9A\x80"), "u\"\\xD83D\" u\"\\xDE80\" u\"\"");
  EXPECT_EQ(literal(DataType::unicode_string, "\"?\\"), "u\"\\x22\" u\"\\x3F\" u\"\\x5C\" u\"\"");
}

TEST(CppInitializer, PutsATextInBraces) {
  Entry entry;
  entry.default_value.emplace().bytes = "hi";
  entry.type = &row(DataType::visible_string);
  EXPECT_EQ(cpp_initializer(entry), "{\"hi\"}");
  entry.type = &row(DataType::octet_string);
  EXPECT_EQ(cpp_initializer(entry), "{0x68, 0x69}");
  entry.default_value->bits = 7;
  entry.type = &row(DataType::unsigned8);
  EXPECT_EQ(cpp_initializer(entry), "7");
}

TEST(TypeWord, IsAConstantOfTheRuntimeForEachDataType) {
  std::string words;
  for (const canopen::DataTypeRow& type : canopen::data_types) words += type_word(type) + " ";
  EXPECT_EQ(
      words,
      "boolean i8 i16 i24 i32 i40 i48 i56 i64 u8 u16 u24 u32 u40 u48 u56 u64 r32 r64 time48 time48 visible_string "
      "octet_string octet_string domain ");
}

TEST(CppString, EscapesWhatWouldEndOrChangeIt) {
  EXPECT_EQ(cpp_string("say \"hi\""), R"("say \"hi\"")");
  EXPECT_EQ(cpp_string(R"(C:\new)"), R"("C:\\new")");
  EXPECT_EQ(cpp_string("what?"
                       "?/"),
            R"("what\?\?/")")
      << "no trigraph";
  EXPECT_EQ(cpp_string("a\nb\tc\x7F"), R"("a\012b\011c\177")");
}

TEST(CppString, WritesUtf8AsOctalBytes) {
  EXPECT_EQ(cpp_string("\xC3\xB6"
                       "7"),
            R"("\303\2667")");
}

TEST(CppComment, IsOneLine) { EXPECT_EQ(cpp_comment("one\ntwo\rthree\tfour"), "one two three four"); }

TEST(CppComment, DoesNotEndInABackslash) {
  EXPECT_EQ(cpp_comment("path\\"), "path/");
  EXPECT_EQ(cpp_comment("a\\b\\"), "a/b/");
}

TEST(CppComment, HoldsNoTrigraphForABackslash) {
  const std::string trigraph =
      "?"
      "?/";
  for (const std::string& text : {"what" + trigraph,
                                  std::string{"what?"
                                              "?\\"},
                                  "?"
                                  "?" +
                                      trigraph + "/"}) {
    EXPECT_EQ(cpp_comment(text).find(trigraph), std::string::npos) << text;
  }
}

TEST(CppComment, ChangesNoDirectionOfWriting) {
  EXPECT_EQ(cpp_comment("a\u202Ab\u202E\u2066\u2069\u200F\u061C\u0085c"),
            "a<U+202A>b<U+202E><U+2066><U+2069><U+200F><U+061C><U+0085>c");
}

TEST(CppComment, KeepsOtherLetters) { EXPECT_EQ(cpp_comment("Größe µ 速度 */"), "Größe µ 速度 */"); }

}  // namespace
}  // namespace edsc
