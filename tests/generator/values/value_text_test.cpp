#include "values/value_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "device/entry_text.hpp"
#include "values/parse_value.hpp"

namespace edsc {
namespace {

using canopen::DataType;
using Bytes = std::vector<std::uint8_t>;

const canopen::DataTypeRow& row(DataType type) { return *canopen::find_data_type(static_cast<std::uint32_t>(type)); }

std::string text(DataType type, const Bytes& bytes) { return value_text(row(type), bytes); }

Bytes parsed(DataType type, std::string_view words) {
  const ParsedValue value = parse_value_text(row(type), words);
  EXPECT_EQ(value.problem, "") << words;
  return value.bytes;
}

std::string problem(DataType type, std::string_view words) {
  const ParsedValue value = parse_value_text(row(type), words);
  EXPECT_TRUE(value.bytes.empty()) << words;
  return value.problem;
}

TEST(ValueText, ShowsNumbersLowByteFirst) {
  EXPECT_EQ(text(DataType::unsigned8, {0x09}), "9");
  EXPECT_EQ(text(DataType::unsigned16, {0x37, 0x02}), "567 (0237h)");
  EXPECT_EQ(text(DataType::unsigned24, {0x01, 0x02, 0x03}), "197121 (030201h)");
  EXPECT_EQ(text(DataType::unsigned64, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}),
            "18446744073709551615 (FFFFFFFFFFFFFFFFh)");
  EXPECT_EQ(text(DataType::integer8, {0x80}), "-128");
  EXPECT_EQ(text(DataType::integer24, {0xFF, 0xFF, 0xFF}), "-1");
  EXPECT_EQ(text(DataType::integer56, {0, 0, 0, 0, 0, 0, 0x80}), "-36028797018963968");
  EXPECT_EQ(text(DataType::real32, {0x00, 0x00, 0x20, 0x40}), "2.5");
  EXPECT_EQ(text(DataType::real64, {0, 0, 0, 0, 0, 0, 0x04, 0xC0}), "-2.5");
  EXPECT_EQ(text(DataType::boolean, {0x01}), "true");
  EXPECT_EQ(text(DataType::boolean, {0x05}), "true (5)");
}

TEST(ValueText, SaysWhereTheLengthIsNotTheTypes) {
  EXPECT_EQ(text(DataType::unsigned16, {0x05}), "5 (1 byte, UNSIGNED16 has 2)");
  EXPECT_EQ(text(DataType::unsigned8, {0x05, 0, 0, 0}), "5 (4 bytes, UNSIGNED8 has 1)");
  EXPECT_EQ(text(DataType::integer32, {}), "nothing (0 bytes, INTEGER32 has 4)");
  EXPECT_EQ(text(DataType::unsigned64, {1, 2, 3, 4, 5, 6, 7, 8, 9}),
            "01 02 03 04 05 06 07 08 09 (9 bytes, UNSIGNED64 has 8)");
}

TEST(ValueText, ShowsStrings) {
  EXPECT_EQ(text(DataType::visible_string, {'R', 'K', '5', 'C', 0, 0}), "\"RK5C\"");
  EXPECT_EQ(text(DataType::visible_string, {'a', '"', '\\', 0x0D, 0xFF}), "\"a\\\"\\\\\\x0D\\xFF\"");
  EXPECT_EQ(text(DataType::unicode_string, {0x41, 0x00, 0xAC, 0x20, 0x3D, 0xD8, 0x00, 0xDE}), "\"A\u20AC\U0001F600\"");
  EXPECT_EQ(text(DataType::unicode_string, {0x00, 0xDC, 0x41}), "\"\uFFFD\uFFFD\"");
  EXPECT_EQ(text(DataType::octet_string, {0xDE, 0xAD}), "DE AD");
  EXPECT_EQ(text(DataType::domain, Bytes(33, 0xAB)).size(), 32 * 3 - 1 + std::string{" ..."}.size());
}

TEST(ValueText, ShowsTimes) {
  EXPECT_EQ(text(DataType::time_of_day, {0, 0, 0, 0, 0, 0}), "1984-01-01 00:00:00.000");
  EXPECT_EQ(text(DataType::time_of_day, {0x95, 0x2C, 0xB3, 0xF2, 0x30, 0x39}), "2024-01-31 12:34:56.789");
  EXPECT_EQ(text(DataType::time_difference, {0xE8, 0x03, 0, 0, 2, 0}), "2 d 00:00:01.000");
}

TEST(ValueText, TakesIntegersInAllSpellings) {
  EXPECT_EQ(parsed(DataType::unsigned16, "567"), (Bytes{0x37, 0x02}));
  EXPECT_EQ(parsed(DataType::unsigned16, "0x237"), (Bytes{0x37, 0x02}));
  EXPECT_EQ(parsed(DataType::unsigned16, "0237h"), (Bytes{0x37, 0x02}));
  EXPECT_EQ(parsed(DataType::unsigned8, "0b101"), (Bytes{0x05}));
  EXPECT_EQ(parsed(DataType::unsigned32, "0b1h"), (Bytes{0xB1, 0, 0, 0}));
  EXPECT_EQ(parsed(DataType::unsigned8, "007"), (Bytes{0x07}));
  EXPECT_EQ(parsed(DataType::integer16, "-1"), (Bytes{0xFF, 0xFF}));
  EXPECT_EQ(parsed(DataType::integer16, "0xFFFF"), (Bytes{0xFF, 0xFF}));
  EXPECT_EQ(parsed(DataType::integer16, "-32768"), (Bytes{0x00, 0x80}));
  EXPECT_EQ(parsed(DataType::integer64, "-9223372036854775808"), (Bytes{0, 0, 0, 0, 0, 0, 0, 0x80}));
  EXPECT_EQ(parsed(DataType::integer24, "+5"), (Bytes{5, 0, 0}));
}

TEST(ValueText, SaysWhatIsWrongWithANumber) {
  EXPECT_EQ(problem(DataType::unsigned8, "256"), "256 does not fit into UNSIGNED8 (0..255)");
  EXPECT_EQ(problem(DataType::unsigned8, "-1"), "-1 does not fit into UNSIGNED8 (0..255)");
  EXPECT_EQ(problem(DataType::integer8, "128"), "128 does not fit into INTEGER8 (-128..127)");
  EXPECT_EQ(problem(DataType::integer8, "0x100"), "0x100 does not fit into INTEGER8 (-128..127)");
  EXPECT_EQ(problem(DataType::unsigned64, "18446744073709551616"),
            "18446744073709551616 does not fit into UNSIGNED64 (0..18446744073709551615)");
  EXPECT_EQ(problem(DataType::unsigned16, "fast"), "\"fast\" is not a number (such as 10, -10, 0x0A or 0Ah)");
  EXPECT_EQ(problem(DataType::unsigned16, ""), "\"\" is not a number (such as 10, -10, 0x0A or 0Ah)");
  EXPECT_EQ(problem(DataType::real32, "1e40"), "1e40 does not fit into REAL32");
  EXPECT_EQ(problem(DataType::real64, "1e400"), "1e400 does not fit into REAL64");
  EXPECT_EQ(problem(DataType::real64, "2,5"), "\"2,5\" is not a number (such as 2.5 or -1e3)");
  EXPECT_EQ(problem(DataType::boolean, "yes"), "\"yes\" is not a BOOLEAN; expected true, false, 1 or 0");
}

TEST(ValueText, TakesStringsAndTimes) {
  EXPECT_EQ(parsed(DataType::visible_string, "a b"), (Bytes{'a', ' ', 'b'}));
  EXPECT_EQ(parsed(DataType::visible_string, "\"a\\x0D\\\"\""), (Bytes{'a', 0x0D, '"'}));
  EXPECT_EQ(parsed(DataType::unicode_string, "\u20AC"), (Bytes{0xAC, 0x20}));
  EXPECT_EQ(parsed(DataType::octet_string, "DE ad"), (Bytes{0xDE, 0xAD}));
  EXPECT_EQ(parsed(DataType::domain, "0xDEAD"), (Bytes{0xDE, 0xAD}));
  EXPECT_EQ(parsed(DataType::time_of_day, "2024-01-31 12:34:56.789"), (Bytes{0x95, 0x2C, 0xB3, 0x02, 0x30, 0x39}));
  EXPECT_EQ(parsed(DataType::time_of_day, "1984-01-02"), (Bytes{0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(parsed(DataType::time_difference, "2 d 00:00:01.5"), (Bytes{0xDC, 0x05, 0, 0, 2, 0}));
  EXPECT_NE(problem(DataType::time_of_day, "2024-02-30 00:00:00"), "");
  EXPECT_NE(problem(DataType::time_of_day, "1983-12-31"), "");
  EXPECT_NE(problem(DataType::time_difference, "25:00:00"), "");
  EXPECT_EQ(problem(DataType::octet_string, "DEA"), "\"DEA\" has an odd number of hexadecimal digits");
  EXPECT_NE(problem(DataType::octet_string, "hello"), "");
}

TEST(ValueText, IsReadBackWhateverItShows) {
  std::mt19937_64 random{1};
  for (const canopen::DataTypeRow& type : canopen::data_types) {
    for (int round = 0; round < 500; ++round) {
      const bool is_string = type.bits == 0;
      Bytes bytes(is_string ? random() % 16 / 2 * 2 : (type.bits + 7U) / 8U);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
      if (type.kind == canopen::DataClass::boolean) bytes[0] &= 1;
      if (type.kind == canopen::DataClass::time) {  // less than a day
        bytes[3] = static_cast<std::uint8_t>(random() % 5);
      }
      if (type.type == DataType::unicode_string) {
        for (std::size_t i = 1; i < bytes.size(); i += 2) bytes[i] &= 0x7F;
      }
      if (is_string && !bytes.empty()) bytes.back() |= 1;                        // trailing zeros are removed
      if (type.type == DataType::real32 && (bytes[3] & 0x7F) == 0x7F) continue;  // NaN
      if (type.type == DataType::real64 && (bytes[7] & 0x7F) == 0x7F) continue;
      const std::string shown = value_text(type, bytes);
      const ParsedValue back = parse_value_text(type, shown);
      EXPECT_EQ(back.problem, "") << type.name << ' ' << shown;
      EXPECT_EQ(back.bytes, bytes) << type.name << ' ' << shown;
    }
  }
}

Entry speed() {
  Entry entry;
  entry.index = 0x2000;
  entry.name = "Speed setpoint";
  entry.type = &row(DataType::integer16);
  Meaning meaning;
  meaning.quantity.emplace();
  meaning.quantity->symbol = "rpm";
  meaning.quantity->unit = canopen::find_unit("rpm");
  entry.meaning = std::make_shared<const Meaning>(meaning);
  entry.low_limit = Value{static_cast<std::uint64_t>(-100), false, false, "", {}, {}};
  entry.high_limit = Value{3000, false, false, "", {}, {}};
  return entry;
}

TEST(ValueText, KnowsUnitAndLimitsOfAnEntry) {
  const Entry entry = speed();
  EXPECT_EQ(value_text(entry, Bytes{0x9C, 0xFF}), "-100 rpm");
  EXPECT_EQ(limits_text(entry), "-100..3000 rpm");
  EXPECT_EQ(parse_value_text(entry, "3000 rpm").bytes, (Bytes{0xB8, 0x0B}));
  EXPECT_EQ(parse_value_text(entry, "-100").bytes, (Bytes{0x9C, 0xFF}));
  EXPECT_EQ(parse_value_text(entry, "3001").problem,
            "3001 is above the high limit of 2000h:00 \"Speed setpoint\", 3000");
  EXPECT_EQ(parse_value_text(entry, "-101").problem,
            "-101 is below the low limit of 2000h:00 \"Speed setpoint\", -100");
  EXPECT_TRUE(parse_value_text(entry, "3001").bytes.empty());
}

}  // namespace
}  // namespace edsc
