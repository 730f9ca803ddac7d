/// Integers, booleans and node-ID formulas of an EDS.
#include "values/read_value.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>

#include "parsed_value.hpp"

namespace edsc {
namespace {

using canopen::DataType;

// ---- integers ----

TEST(IntegerValue, IsDecimalHexadecimalOrOctal) {
  struct Row {
    const char* text;
    std::uint64_t number;
  };
  for (const Row& row : {Row{"0", 0}, Row{"1536", 1536}, Row{"0x600", 1536}, Row{"0X6aB", 0x6AB}, Row{"007", 7},
                         Row{"000", 0}, Row{"+5", 5}, Row{" 12 ", 12}, Row{"12 ; seconds", 12}, Row{"0x10#hex", 16}}) {
    const Parsed parsed(DataType::unsigned32, row.text);
    EXPECT_EQ(parsed.bits(), row.number) << row.text;
    EXPECT_EQ(findings(parsed.diagnostics), none) << row.text;
  }
}

TEST(IntegerValue, RemembersThatItIsSpelledInHexadecimal) {
  EXPECT_TRUE(Parsed(DataType::unsigned32, "0x600").value->hexadecimal);
  EXPECT_FALSE(Parsed(DataType::unsigned32, "600").value->hexadecimal);
}

TEST(IntegerValue, KnowsItsPlace) {
  const Parsed parsed(DataType::unsigned8, "3");
  EXPECT_EQ(parsed.value->position.line, 2U);
  EXPECT_EQ(parsed.value->position.column, 14U);
}

TEST(IntegerValue, IsNothingWhenTheKeyIsMissingOrEmpty) {
  Diagnostics diagnostics;
  const auto& type = *canopen::find_data_type(0x07);
  EXPECT_FALSE(parse_value(Field{}, type, std::nullopt, diagnostics));
  EXPECT_FALSE(Parsed(DataType::unsigned32, "").value);
  EXPECT_FALSE(Parsed(DataType::unsigned32, "  ").value);
  EXPECT_EQ(findings(diagnostics), none);
}

TEST(IntegerValue, ThatIsNoNumberIsAnError) {
  for (const char* text : {"abc", "0x", "0xG1", "--5", "1 2", "1.5", "0b101", "1e40", "nan", "inf"}) {
    const Parsed parsed(DataType::unsigned32, text);
    EXPECT_FALSE(parsed.value) << text;
    EXPECT_EQ(findings(parsed.diagnostics), error_of("number-format")) << text;
  }
}

TEST(IntegerValue, NamesTypeAndTextInTheMessage) {
  const Parsed parsed(DataType::integer16, "fast");
  const std::string& message = parsed.diagnostics.all().front().message;
  EXPECT_NE(message.find("INTEGER16"), std::string::npos) << message;
  EXPECT_NE(message.find("\"fast\""), std::string::npos) << message;
}

TEST(IntegerValue, ThatDoesNotFitIntoItsTypeIsAnError) {
  struct Row {
    DataType type;
    const char* text;
  };
  for (const Row& row :
       {Row{DataType::unsigned8, "256"}, Row{DataType::unsigned16, "0x10000"}, Row{DataType::unsigned24, "0x1000000"},
        Row{DataType::unsigned32, "4294967296"}, Row{DataType::unsigned40, "0x10000000000"},
        Row{DataType::integer8, "256"}, Row{DataType::integer8, "-129"}, Row{DataType::integer16, "-0x8001"},
        Row{DataType::integer24, "-8388609"}, Row{DataType::integer56, "-0x80000000000001"}}) {
    const Parsed parsed(row.type, row.text);
    EXPECT_FALSE(parsed.value) << row.text;
    EXPECT_EQ(findings(parsed.diagnostics), error_of("number-range")) << row.text;
  }
}

TEST(IntegerValue, OfMoreThanSixtyFourBitsIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::unsigned64, "18446744073709551616").diagnostics), error_of("number-format"));
}

TEST(IntegerValue, ReachesBothEndsOfItsType) {
  EXPECT_EQ(Parsed(DataType::unsigned64, "0xFFFFFFFFFFFFFFFF").bits(), ~std::uint64_t{0});
  EXPECT_EQ(Parsed(DataType::integer64, "-9223372036854775808").bits(), std::uint64_t{1} << 63);
  EXPECT_EQ(Parsed(DataType::integer64, "9223372036854775807").number(), INT64_MAX);
  EXPECT_EQ(Parsed(DataType::integer8, "-128").number(), -128);
  EXPECT_EQ(Parsed(DataType::integer24, "-8388608").number(), -8388608);
  EXPECT_EQ(Parsed(DataType::unsigned24, "16777215").bits(), 0xFFFFFFU);
}

TEST(IntegerValue, MayBeNegativeInEveryBase) {
  for (const char* text : {"-16", "- 16", "-0x10", "-0X10"}) {
    const Parsed parsed(DataType::integer16, text);
    EXPECT_EQ(parsed.number(), -16) << text;
    EXPECT_EQ(findings(parsed.diagnostics), none) << text;
  }
  EXPECT_EQ(Parsed(DataType::integer16, "-0").number(), 0);
}

TEST(IntegerValue, InHexadecimalMayBeATwosComplement) {
  const Parsed parsed(DataType::integer16, "0xFFFE");
  EXPECT_EQ(parsed.number(), -2);
  EXPECT_EQ(findings(parsed.diagnostics), none);
  EXPECT_EQ(Parsed(DataType::integer24, "0x800000").number(), -8388608);
  EXPECT_EQ(Parsed(DataType::integer64, "0xFFFFFFFFFFFFFFFF").number(), -1);
}

TEST(IntegerValue, ThatIsOctalSaysSo) {
  const Parsed parsed(DataType::unsigned32, "017");
  EXPECT_EQ(parsed.bits(), 15U);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling"));
  EXPECT_EQ(Parsed(DataType::integer16, "-020").number(), -16);
}

TEST(IntegerValue, WithAnHBehindItIsHexadecimalAndSaysSo) {
  for (const char* text : {"80h", "0000 0080h", "080H"}) {
    const Parsed parsed(DataType::unsigned32, text);
    EXPECT_EQ(parsed.bits(), 0x80U) << text;
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling")) << text;
  }
  for (const char* text : {"h", "beach", "80h or 90h", "CAN-ID: 80h"}) {
    EXPECT_EQ(findings(Parsed(DataType::unsigned32, text).diagnostics), error_of("number-format")) << text;
  }
}

TEST(IntegerValue, InDecimalOverTheHighestIsTakenForATwosComplementWithAWarning) {
  const Parsed parsed(DataType::integer8, "255");
  EXPECT_EQ(parsed.number(), -1);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-range"));
}

TEST(IntegerValue, NegativeOfAnUnsignedTypeIsATwosComplementWithAWarning) {
  const Parsed parsed(DataType::unsigned16, "-1");
  EXPECT_EQ(parsed.bits(), 0xFFFFU);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-range"));
}

TEST(IntegerValue, WithACSuffixIsReadWithAWarning) {
  for (const char* text : {"12L", "12ul", "12LL", "0xCu"}) {
    const Parsed parsed(DataType::integer32, text);
    EXPECT_EQ(parsed.number(), 12) << text;
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling")) << text;
  }
}

TEST(IntegerValue, WithADecimalPointIsReadWhenNothingIsLost) {
  const Parsed parsed(DataType::integer32, "-25.0");
  EXPECT_EQ(parsed.number(), -25);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling"));
  EXPECT_EQ(Parsed(DataType::unsigned32, "1e3").bits(), 1000U);
}

TEST(IntegerValue, WithALeadingZeroAndADigitThatIsNotOctalIsDecimalAndSaysSo) {
  const Parsed parsed(DataType::unsigned32, "0089");
  EXPECT_EQ(parsed.bits(), 89U);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling"));
  EXPECT_NE(parsed.diagnostics.all().front().message.find("octal"), std::string::npos)
      << parsed.diagnostics.all().front().message;
}

// ---- booleans ----

TEST(BooleanValue, IsZeroOrOne) {
  EXPECT_EQ(Parsed(DataType::boolean, "0").bits(), 0U);
  EXPECT_EQ(Parsed(DataType::boolean, "1").bits(), 1U);
  EXPECT_EQ(Parsed(DataType::boolean, "0x1").bits(), 1U);
  EXPECT_EQ(findings(Parsed(DataType::boolean, "0x1").diagnostics), none);
}

TEST(BooleanValue, InWordsOrOverOneIsReadWithAWarning) {
  EXPECT_EQ(Parsed(DataType::boolean, "TRUE").bits(), 1U);
  EXPECT_EQ(Parsed(DataType::boolean, "false").bits(), 0U);
  EXPECT_EQ(findings(Parsed(DataType::boolean, "True").diagnostics), warning_of("number-spelling"));
  EXPECT_EQ(Parsed(DataType::boolean, "255").bits(), 1U);
  EXPECT_EQ(findings(Parsed(DataType::boolean, "255").diagnostics), warning_of("number-range"));
}

TEST(BooleanValue, ThatIsNoNumberIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::boolean, "yes").diagnostics), error_of("number-format"));
}

// ---- node-ID formulas (CiA 306-1, 4.6.2.3) ----

TEST(NodeIdFormula, IsReadInEverySpelling) {
  for (const char* text : {"$NODEID+0x180", "$NODEID + 0x180", "$NODEID+384", "$NodeId+0x180", "0x180+$NODEID",
                           "384 + $nodeid", "$NODEID+0x180 ; TPDO 1", "$NODEID+0600"}) {
    const Parsed parsed(DataType::unsigned32, text);
    ASSERT_TRUE(parsed.value) << text;
    EXPECT_EQ(parsed.value->bits, 0x180U) << text;
    EXPECT_TRUE(parsed.value->plus_node_id) << text;
    EXPECT_EQ(findings(parsed.diagnostics), none) << text;
  }
}

TEST(NodeIdFormula, MayBeTheNodeIdAlone) {
  const Parsed parsed(DataType::unsigned8, "$NODEID");
  EXPECT_EQ(parsed.bits(), 0U);
  EXPECT_TRUE(parsed.value->plus_node_id);
}

TEST(NodeIdFormula, BecomesANumberWhenTheNodeIdIsKnown) {
  const Parsed parsed(DataType::unsigned32, "$NODEID+0x180", std::uint8_t{5});
  EXPECT_EQ(parsed.bits(), 0x185U);
  EXPECT_FALSE(parsed.value->plus_node_id);
}

TEST(NodeIdFormula, WithAVendorsVariableIsReadWithAWarning) {
  for (const char* text : {"$NODE_ID+0x180", "$MY_NODE_ID+0x180"}) {
    const Parsed parsed(DataType::unsigned32, text);
    EXPECT_EQ(parsed.bits(), 0x180U) << text;
    EXPECT_EQ(findings(parsed.diagnostics), warning_of("node-id-formula")) << text;
  }
}

TEST(NodeIdFormula, WithTwoConstantsIsReadWithAWarning) {
  const Parsed parsed(DataType::unsigned32, "0x180 + $NODEID + 0x40000000");
  EXPECT_EQ(parsed.bits(), 0x4000'0180U);
  EXPECT_TRUE(parsed.value->plus_node_id);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("node-id-formula"));
  EXPECT_EQ(findings(Parsed(DataType::unsigned8, "0xFF+$NODEID+0xFF").diagnostics), error_of("node-id-formula"));
}

TEST(NodeIdFormula, ThatIsNoneIsAnError) {
  for (const char* text : {"$NODEID+", "+$NODEID", "$NODEID-1", "$NODEID+abc", "$NODEID*2", "$NODEID+0x180+", "$",
                           "$NODEID+1+$NODEID", "$NODEID+1+x", "1+2+3$", "$OTHER+1", "2*$NODEID"}) {
    const Parsed parsed(DataType::unsigned32, text);
    EXPECT_FALSE(parsed.value) << text;
    EXPECT_EQ(findings(parsed.diagnostics), error_of("node-id-formula")) << text;
  }
}

TEST(IntegerValue, InQuotationMarksIsReadWithAWarning) {
  const Parsed parsed(DataType::unsigned16, "\"0x64\"");
  EXPECT_EQ(parsed.bits(), 0x64U);
  EXPECT_EQ(findings(parsed.diagnostics), warning_of("number-spelling"));
}

TEST(NodeIdFormula, ThatDoesNotFitIntoItsTypeIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::unsigned8, "$NODEID+0x180").diagnostics), error_of("number-range"));
}

TEST(NodeIdFormula, ThatDoesNotFitWithTheNodeIdAddedIsAnError) {
  EXPECT_EQ(Parsed(DataType::unsigned8, "$NODEID+0xF0", std::uint8_t{15}).bits(), 0xFFU);
  EXPECT_EQ(findings(Parsed(DataType::unsigned8, "$NODEID+0xF0", std::uint8_t{16}).diagnostics),
            error_of("number-range"));
}

TEST(NodeIdFormula, ThatExceedsItsTypeIsNeverWrapped) {
  struct Row {
    DataType type;
    const char* constant;
    unsigned last_node_id;  ///< with which the sum fits
  };
  for (const Row& row : {Row{DataType::unsigned8, "0x80", 127},
                         Row{DataType::unsigned8, "0x81", 126},
                         Row{DataType::unsigned8, "0xFE", 1},
                         Row{DataType::unsigned8, "0xFF", 0},
                         Row{DataType::integer8, "0x00", 127},
                         Row{DataType::integer8, "0x01", 126},
                         Row{DataType::integer8, "0x7F", 0},
                         Row{DataType::integer8, "0x80", 127},
                         Row{DataType::integer8, "0xFF", 127},
                         Row{DataType::integer8, "128", 0},
                         Row{DataType::integer16, "0x7FFE", 1},
                         Row{DataType::unsigned24, "0xFFFFC0", 63},
                         Row{DataType::unsigned32, "0xFFFFFF80", 127},
                         Row{DataType::unsigned32, "0xFFFFFF81", 126},
                         Row{DataType::unsigned32, "4294967295", 0},
                         Row{DataType::unsigned64, "0xFFFFFFFFFFFFFF80", 127},
                         Row{DataType::unsigned64, "0xFFFFFFFFFFFFFFFE", 1},
                         Row{DataType::unsigned64, "0xFFFFFFFFFFFFFFFF", 0},
                         Row{DataType::integer64, "0x7FFFFFFFFFFFFF80", 127},
                         Row{DataType::integer64, "0x7FFFFFFFFFFFFFFF", 0},
                         Row{DataType::integer64, "0xFFFFFFFFFFFFFFFF", 127},
                         Row{DataType::integer64, "0x8000000000000000", 127},
                         Row{DataType::unsigned32, "0xFFFFFFFFFFFFFFFF", 0},
                         Row{DataType::integer8, "0xFFFFFFFFFFFFFFFF", 0}}) {
    const std::string text = std::string{"$NODEID+"} + row.constant;
    const Parsed any(row.type, text);
    EXPECT_EQ(any.value.has_value(), row.last_node_id == 127) << text;
    EXPECT_EQ(findings(any.diagnostics), row.last_node_id == 127 ? none : error_of("number-range")) << text;
    for (unsigned node_id = 1; node_id <= 127; ++node_id) {
      const Parsed parsed(row.type, text, static_cast<std::uint8_t>(node_id));
      EXPECT_EQ(parsed.value.has_value(), node_id <= row.last_node_id) << text << " " << node_id;
      EXPECT_EQ(findings(parsed.diagnostics), parsed.value ? none : error_of("number-range")) << text << " " << node_id;
    }
  }
}

TEST(NodeIdFormula, OfMoreThanSixtyFourBitsIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::unsigned64, "$NODEID+0x10000000000000000").diagnostics),
            error_of("node-id-formula"));
}

TEST(NodeIdFormula, NamesTheNodeIdsWithWhichItDoesNotFit) {
  const auto message = [](const char* text, std::optional<std::uint8_t> node_id) {
    return Parsed(DataType::unsigned8, text, node_id).diagnostics.all().front().message;
  };
  EXPECT_EQ(message("$NODEID+0xFF", std::nullopt), "\"$NODEID+0xFF\" does not fit into UNSIGNED8 with any node-ID");
  EXPECT_EQ(message("$NODEID+0xC0", std::nullopt),
            "\"$NODEID+0xC0\" does not fit into UNSIGNED8 with node-IDs above 63");
  EXPECT_EQ(message("$NODEID+0xC0", std::uint8_t{64}), "\"$NODEID+0xC0\" does not fit into UNSIGNED8 with node-ID 64");
}

TEST(NodeIdFormula, OfASignedTypeIsExtendedToItsSign) {
  EXPECT_EQ(Parsed(DataType::integer16, "$NODEID+0xFF00").number(), -256);
  EXPECT_EQ(Parsed(DataType::integer16, "$NODEID+0xFF00", std::uint8_t{1}).number(), -255);
}

TEST(NodeIdFormula, OfARealOrBooleanIsAnError) {
  EXPECT_EQ(findings(Parsed(DataType::real32, "$NODEID+1").diagnostics), error_of("number-format"));
  EXPECT_EQ(findings(Parsed(DataType::boolean, "$NODEID").diagnostics), error_of("number-format"));
}

}  // namespace
}  // namespace edsc
