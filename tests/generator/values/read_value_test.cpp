/// Reals, times, strings, domains and limits of an EDS.
#include "values/read_value.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "parsed_value.hpp"

namespace edsc {
namespace {

using canopen::DataType;

// ---- reals ----

TEST(RealValue, IsADecimalNumber) {
  for (const char* text : {"1.5", "+1.5", "15e-1", "1.5 ; factor"}) {
    EXPECT_EQ(Parsed(DataType::real32, text).bits(), std::bit_cast<std::uint32_t>(1.5F)) << text;
    EXPECT_EQ(Parsed(DataType::real64, text).bits(), std::bit_cast<std::uint64_t>(1.5)) << text;
  }
  EXPECT_EQ(Parsed(DataType::real32, "-2").bits(), std::bit_cast<std::uint32_t>(-2.0F));
  EXPECT_EQ(Parsed(DataType::real64, "0.1").bits(), std::bit_cast<std::uint64_t>(0.1));
  EXPECT_EQ(Parsed(DataType::real32, "0.1").bits(), std::bit_cast<std::uint32_t>(0.1F));
}

TEST(RealValue, InHexadecimalIsItsPattern) {
  EXPECT_EQ(Parsed(DataType::real32, "0x3F800000").bits(), std::bit_cast<std::uint32_t>(1.0F));
  EXPECT_EQ(Parsed(DataType::real64, "0x3FF0000000000000").bits(), std::bit_cast<std::uint64_t>(1.0));
  EXPECT_EQ(findings(Parsed(DataType::real32, "0x13F800000").diagnostics), error_of("number-range"));
}

TEST(RealValue, WithACSuffixIsReadWithAWarning) {
  for (const char* text : {"0.5f", ".5F", "0.5L"}) {
    const Parsed parsed(DataType::real32, text);
    EXPECT_EQ(parsed.bits(), std::bit_cast<std::uint32_t>(0.5F)) << text;
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling")) << text;
  }
}

TEST(RealValue, BeyondItsTypeIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::real32, "1e39").diagnostics), error_of("number-range"));
  EXPECT_EQ(Parsed(DataType::real64, "1e400").diagnostics.errors(), 1U);
  EXPECT_EQ(Parsed(DataType::real64, "1e39").bits(), std::bit_cast<std::uint64_t>(1e39));
}

TEST(RealValue, ThatIsNoNumberIsAnError) {
  for (const char* text : {"fast", "1,5", "1.5ff", "f", "0xfoo"}) {
    EXPECT_EQ(findings(Parsed(DataType::real32, text).diagnostics), error_of("number-format")) << text;
  }
}

// ---- times ----

TEST(TimeValue, IsFortyEightBitsOrDaysAndMilliseconds) {
  EXPECT_EQ(Parsed(DataType::time_of_day, "0x000100000002").bits(), 0x1'0000'0002U);
  EXPECT_EQ(Parsed(DataType::time_difference, "3 1000").bits(), (std::uint64_t{3} << 32) | 1000U);
  EXPECT_EQ(Parsed(DataType::time_of_day, "0").bits(), 0U);
  EXPECT_EQ(findings(Parsed(DataType::time_of_day, "0x1000000000000").diagnostics), error_of("number-range"));
  EXPECT_EQ(findings(Parsed(DataType::time_of_day, "noon").diagnostics), error_of("number-format"));
}

// ---- strings and domains ----

TEST(StringValue, IsTheTextAsItStands) {
  const Parsed parsed(DataType::visible_string, "a ; b # c = \"d\"");
  EXPECT_EQ(parsed.value->bytes, "a ; b # c = \"d\"");
  EXPECT_EQ(findings(parsed.diagnostics), none);
  EXPECT_EQ(Parsed(DataType::visible_string, "$NODEID").value->bytes, "$NODEID");
  EXPECT_EQ(Parsed(DataType::unicode_string, "größe").value->bytes, "größe");
}

TEST(StringValue, KeepsQuotationMarksAndWarnsOfThem) {
  for (const DataType type : {DataType::visible_string, DataType::unicode_string}) {
    const Parsed parsed(type, "\"IO\"");
    EXPECT_EQ(parsed.value->bytes, "\"IO\"");
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("string-quotes"));
  }
  EXPECT_EQ(findings(Parsed(DataType::visible_string, "5\" pipe").diagnostics), none);
}

TEST(StringValue, OfOctetsIsPairsOfHexadecimalDigits) {
  EXPECT_EQ(Parsed(DataType::octet_string, "01 aF").value->bytes, "\x01\xAF");
  EXPECT_EQ(Parsed(DataType::octet_string, "0x01AF").value->bytes, "\x01\xAF");
}

TEST(StringValue, OfOctetsThatAreNoPairsIsTakenAsTextWithAWarning) {
  for (const char* text : {"hello", "123", "0x1"}) {
    const Parsed parsed(DataType::octet_string, text);
    EXPECT_EQ(parsed.value->bytes, text);
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("octet-string")) << text;
  }
}

TEST(DomainValue, IsLeftOutWithAWarning) {
  const Parsed parsed(DataType::domain, "1");
  EXPECT_FALSE(parsed.value);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("domain-value"));
  EXPECT_EQ(findings(Parsed(DataType::domain, "").diagnostics), none);
}

// ---- limits ----

/// LowLimit or HighLimit of an entry of this type.
struct ParsedLimit {
  ParsedLimit(Limit which, DataType data_type, std::string text, std::optional<std::uint8_t> node_id = std::nullopt)
      : source("value.eds", "[2000]\nDefaultValue=" + text + "\n"),
        value(parse_limit({source.line(2).substr(std::string_view{"DefaultValue="}.size()), {&source, 2, 14}, true},
                          which, *canopen::find_data_type(static_cast<std::uint32_t>(data_type)), node_id,
                          diagnostics)) {}

  SourceFile source;
  Diagnostics diagnostics;
  std::optional<Value> value;
};

TEST(LimitValue, MayBeATwosComplement) {
  const ParsedLimit low(Limit::low, DataType::integer32, "0x80000000");
  EXPECT_EQ(static_cast<std::int64_t>(low.value->bits), -2147483648);
  const ParsedLimit high(Limit::high, DataType::integer8, "0xFF");
  EXPECT_EQ(static_cast<std::int64_t>(high.value->bits), -1);
  EXPECT_EQ(findings(low.diagnostics), none);
  EXPECT_EQ(findings(high.diagnostics), none);
}

TEST(LimitValue, BeyondItsTypeLimitsNothing) {
  struct Row {
    Limit which;
    DataType type;
    const char* text;
  };
  for (const Row& row :
       {Row{Limit::low, DataType::unsigned16, "-4096"}, Row{Limit::high, DataType::unsigned8, "0xFFFF"},
        Row{Limit::high, DataType::integer32, "4294967295"}, Row{Limit::low, DataType::integer8, "-129"},
        Row{Limit::high, DataType::real32, "1e300"}, Row{Limit::low, DataType::real32, "-1e300"}}) {
    const ParsedLimit parsed(row.which, row.type, row.text);
    EXPECT_FALSE(parsed.value) << row.text;
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-range")) << row.text;
  }
}

TEST(LimitValue, ThatExceedsItsTypeWithTheNodeIdLimitsNothing) {
  EXPECT_EQ(ParsedLimit(Limit::high, DataType::integer8, "$NODEID+0x7A", std::uint8_t{5}).value->bits, 0x7FU);
  const ParsedLimit high(Limit::high, DataType::integer8, "$NODEID+0x7B", std::uint8_t{5});
  EXPECT_FALSE(high.value);
  EXPECT_EQ(findings(high.diagnostics), warning_of("number-range"));
  const ParsedLimit low(Limit::low, DataType::integer8, "$NODEID+0x7B", std::uint8_t{5});
  EXPECT_FALSE(low.value);
  EXPECT_EQ(findings(low.diagnostics), error_of("number-range"));
  const ParsedLimit unknown(Limit::high, DataType::integer8, "$NODEID+0x7B");
  ASSERT_TRUE(unknown.value);
  EXPECT_TRUE(unknown.value->plus_node_id);
}

TEST(LimitValue, ThatNoValueCanMeetIsAnError) {
  EXPECT_EQ(findings(ParsedLimit(Limit::low, DataType::unsigned8, "300").diagnostics), error_of("number-range"));
  EXPECT_EQ(findings(ParsedLimit(Limit::high, DataType::unsigned8, "-1").diagnostics), error_of("number-range"));
}

}  // namespace
}  // namespace edsc
