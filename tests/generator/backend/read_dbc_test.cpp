#include "backend/dbc/read_dbc.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

namespace edsc {
namespace {

struct DbcText {
  explicit DbcText(std::string text) : source{"plant.dbc", std::move(text)}, messages{read_dbc(source, diagnostics)} {}

  SourceFile source;
  Diagnostics diagnostics;
  std::vector<DbcFileMessage> messages;
};

using DbcPlace = std::tuple<std::string, unsigned, unsigned, bool>;

std::vector<DbcPlace> dbc_places(const DbcFileMessage& message) {
  std::vector<DbcPlace> found;
  for (const DbcFileSignal& one : message.signals) {
    found.emplace_back(one.name, one.first_bit, one.bits, one.has_pdo_layout);
  }
  return found;
}

TEST(ReadDbc, HasMessagesWithTheirSignalsAndLines) {
  const DbcText dbc{
      "VERSION \"\"\r\n\r\nBU_: a b\r\n\r\nBO_ 385 drive: 8 a\r\n SG_ position : 0|32@1- (1,0) [0|0] \"inc\" b,c\r\n"
      " SG_ speed:32|16@1+ (0.1,-5) [0|0] \"\" Vector__XXX\r\n\r\nBO_ 2566843902 wide : 1 Vector__XXX\r\n"};
  EXPECT_EQ(dbc.diagnostics.all().size(), 0);
  ASSERT_EQ(dbc.messages.size(), 2);
  EXPECT_EQ(dbc.messages[0].name, "drive");
  EXPECT_EQ(dbc.messages[0].can_id, 0x181);
  EXPECT_FALSE(dbc.messages[0].extended);
  EXPECT_EQ(dbc.messages[0].position.line, 5);
  EXPECT_EQ(dbc_places(dbc.messages[0]), (std::vector<DbcPlace>{{"position", 0, 32, true}, {"speed", 32, 16, true}}));
  EXPECT_EQ(dbc.messages[0].signals[1].position.line, 7);
  EXPECT_EQ(dbc.messages[1].can_id, 0x18FEEDFE);
  EXPECT_TRUE(dbc.messages[1].extended);
}

/// The start bit of Motorola signals is the highest one: bit 7 of byte 0 is 7, bit 0 of byte 1 is 8.
TEST(ReadDbc, PlacesBigEndianSignalsOfOneByte) {
  const DbcText dbc{
      "BO_ 1 m: 8 a\n SG_ byte_1 : 15|8@0+ (1,0) [0|0] \"\" b\n SG_ bit_0 : 0|1@0+ (1,0) [0|0] \"\" b\n"
      " SG_ word : 7|16@0+ (1,0) [0|0] \"\" b\n"};
  ASSERT_EQ(dbc.messages.size(), 1);
  EXPECT_EQ(dbc_places(dbc.messages[0]),
            (std::vector<DbcPlace>{{"byte_1", 8, 8, true}, {"bit_0", 0, 1, true}, {"word", 7, 16, false}}));
}

TEST(ReadDbc, MarksMultiplexedSignals) {
  const DbcText dbc{
      "BO_ 1 m: 8 a\n SG_ which M : 0|8@1+ (1,0) [0|0] \"\" b\n SG_ one m0 : 8|8@1+ (1,0) [0|0] \"\" b\n"};
  ASSERT_EQ(dbc.messages.size(), 1);
  EXPECT_EQ(dbc_places(dbc.messages[0]), (std::vector<DbcPlace>{{"which", 0, 8, false}, {"one", 8, 8, false}}));
}

TEST(ReadDbc, TakesLongNames) {
  const DbcText dbc{
      "BO_ 1 m: 8 a\n SG_ short : 0|8@1+ (1,0) [0|0] \"\" b\nBO_ 2 n: 8 a\n SG_ short : 0|8@1+ (1,0) [0|0] \"\" b\n"
      "BA_ \"SystemSignalLongSymbol\" SG_ 2 short \"a_name_of_more_than_32_characters\";\n"};
  ASSERT_EQ(dbc.messages.size(), 2);
  EXPECT_EQ(dbc.messages[0].signals[0].name, "short");
  EXPECT_EQ(dbc.messages[1].signals[0].name, "a_name_of_more_than_32_characters");
}

TEST(ReadDbc, SkipsTextOfSeveralLinesAndSignalsWithoutAMessage) {
  const DbcText dbc{
      "BO_ 1 m: 8 a\nCM_ BO_ 1 \"first line\nBO_ 2 not a message\nlast\";\n"
      "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ x : 0|8@1+ (1,0) [0|0] \"\" b\n"};
  EXPECT_EQ(dbc.diagnostics.all().size(), 0);
  ASSERT_EQ(dbc.messages.size(), 1);
  EXPECT_TRUE(dbc.messages[0].signals.empty());
}

TEST(ReadDbc, ReportsLinesThatAreNoMessagesAndSignals) {
  for (const std::string line :
       {"BO_ x m: 8 a", "BO_ 5", "BO_ 1073741824 m: 8 a", " SG_ s : 0|0@1+ (1,0)", " SG_ s 0|8@1+", " SG_ s : 0|8@2+",
        " SG_ s : 0-8@1+", " SG_ s : 4294967296|8@1+", " SG_", " SG_ s : 512|8@1+"}) {
    const DbcText dbc{"BO_ 1 m: 8 a\n" + line + "\n"};
    ASSERT_EQ(dbc.diagnostics.all().size(), 1) << line;
    EXPECT_EQ(dbc.diagnostics.all()[0].position.line, 2) << line;
    EXPECT_EQ(dbc.diagnostics.errors(), 0) << line;
  }
}

TEST(ReadDbc, ReportsAFileWithoutMessages) {
  for (const std::string text : {"", "[FileInfo]\nFileName=x.eds\n", "BO_TX_BU_ 5 : a;\n"}) {
    EXPECT_EQ(DbcText{text}.diagnostics.errors(), 1) << text;
  }
}

}  // namespace
}  // namespace edsc
