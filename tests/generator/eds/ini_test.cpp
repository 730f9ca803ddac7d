#include "eds/ini.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using std::string_literals::operator""s;

struct ReadLines {
  explicit ReadLines(std::string text) : source("test.eds", std::move(text)), ini(parse_ini(source, diagnostics)) {}

  SourceFile source;
  Diagnostics diagnostics;
  IniFile ini;
};

using Findings = std::vector<Finding>;

TEST(IniReader, ReadsSectionsAndTheirEntries) {
  const ReadLines read("[FileInfo]\nFileName=a.eds\n\n[1000]\nParameterName=Device type\nObjectType=0x7\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  ASSERT_EQ(read.ini.sections.size(), 2U);
  EXPECT_EQ(read.ini.sections[0].name, "FileInfo");
  EXPECT_EQ(read.ini.sections[1].name, "1000");
  ASSERT_EQ(read.ini.sections[1].entries.size(), 2U);
  EXPECT_EQ(read.ini.sections[1].entries[0].key, "ParameterName");
  EXPECT_EQ(read.ini.sections[1].entries[0].value, "Device type");
}

TEST(IniReader, KnowsTheirPlaces) {
  const ReadLines read(" [ 1000 ]\n  DataType =  0x7 \nDefaultValue=\n");
  const IniSection& section = read.ini.sections.at(0);
  EXPECT_EQ(section.name, "1000");
  EXPECT_EQ(section_position(read.source, section).line, 1U);
  EXPECT_EQ(section_position(read.source, section).column, 4U);
  EXPECT_EQ(section_position(read.source, section).length, 4U);
  EXPECT_EQ(key_position(read.source, section.entries.at(0)).column, 3U);
  EXPECT_EQ(key_position(read.source, section.entries.at(0)).length, 8U);
  EXPECT_EQ(value_position(read.source, section.entries.at(0)).column, 15U);
  EXPECT_EQ(value_position(read.source, section.entries.at(0)).length, 3U);
  EXPECT_EQ(value_position(read.source, section.entries.at(1)).line, 3U);
  EXPECT_EQ(value_position(read.source, section.entries.at(1)).column, 14U);
  EXPECT_EQ(value_position(read.source, section.entries.at(1)).length, 1U);
}

TEST(IniReader, TakesAHeaderAsAWholeLine) {
  const ReadLines read("[2000]\nParameterName=Filter time [ms]\n");
  ASSERT_EQ(read.ini.sections.size(), 1U);
  EXPECT_EQ(read.ini.sections[0].entries.at(0).value, "Filter time [ms]");
}

TEST(IniReader, SplitsAnEntryAtTheFirstEqualsSign) {
  const ReadLines read("[2000]\nParameterName=Mask [Bit0=a]\n");
  EXPECT_EQ(read.ini.sections.at(0).entries.at(0).key, "ParameterName");
  EXPECT_EQ(read.ini.sections.at(0).entries.at(0).value, "Mask [Bit0=a]");
}

TEST(IniReader, LeavesQuotesAndCommentMarksInValues) {
  const ReadLines read("[2000]\nDefaultValue=\"a b\"\nParameterName=Sensor #1; left\n");
  EXPECT_EQ(read.ini.sections.at(0).entries.at(0).value, "\"a b\"");
  EXPECT_EQ(read.ini.sections.at(0).entries.at(1).value, "Sensor #1; left");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
}

TEST(IniReader, SkipsCommentsAndBlankLines) {
  const ReadLines read("; first\n \t\n[1000] ; device type\n  ;DefaultValue=1\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_TRUE(read.ini.sections.at(0).entries.empty());
}

TEST(IniReader, WarnsOnceOfHashComments) {
  const ReadLines read("[1000]\n # one\n#two=2\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(2, 2, "hash-comment")}));
  EXPECT_TRUE(read.ini.sections.at(0).entries.empty());
}

TEST(IniReader, WarnsOfTextBehindAHeader) {
  const ReadLines read("[1000] device type\n[1001] # comment\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(1, 8, "text-after-section")}));
  EXPECT_EQ(read.ini.sections.size(), 2U);
}

TEST(IniReader, LeavesOutTheEntriesOfAHeaderWithoutEnd) {
  const ReadLines read("[1000]\nA=1\n  [1001\nB=2\n[1002]\nC=3\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(3, 3, "unterminated-section")}));
  ASSERT_EQ(read.ini.sections.size(), 2U);
  EXPECT_EQ(read.ini.sections[0].entries.size(), 1U);
  EXPECT_EQ(read.ini.sections[1].entries.size(), 1U);
}

TEST(IniReader, WarnsOfAStrayLine) {
  const ReadLines read("[1000]\nno entry\n =5\nA=1\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(2, 1, "stray-line"), warning_at(3, 2, "stray-line")}));
  EXPECT_EQ(read.ini.sections.at(0).entries.size(), 1U);
}

TEST(IniReader, ReportsTheFirstEntryOutsideOfSections) {
  const ReadLines read("; comment\n FileName=a.eds\nFileVersion=1\n[1000]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(2, 2, "entry-outside-section")}));
  EXPECT_EQ(read.ini.sections.size(), 1U);
}

TEST(IniReader, RefusesABinaryFile) {
  const ReadLines read("[1000]\nA=\0\n[1001]\n"s);
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(2, 3, "binary-file")}));
  EXPECT_TRUE(read.ini.sections.empty());
  EXPECT_EQ(findings(ReadLines("[1000]\r\n\x1B[31m\r\n").diagnostics), (Findings{error_at(2, 1, "binary-file")}));
  EXPECT_EQ(findings(ReadLines("[1000]\n\x1A\nA=1\n").diagnostics), (Findings{error_at(2, 1, "binary-file")}));
}

TEST(IniReader, LetsACtrlZEndTheText) {
  const ReadLines read("[1000]\nA=1\x1A");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.ini.sections.at(0).entries.at(0).value, "1");
  EXPECT_EQ(findings(ReadLines("[1000]\r\n\x1A\x1A\r\n").diagnostics), Findings{});
}

TEST(IniReader, ReportsAFileWithoutSections) {
  const Findings empty{error_at(0, 0, "empty-file")};
  EXPECT_EQ(findings(ReadLines("").diagnostics), empty);
  EXPECT_EQ(findings(ReadLines("\n \n; comment\n").diagnostics), empty);
  EXPECT_EQ(findings(ReadLines("junk\n").diagnostics, "empty-file"), empty);
}

TEST(IniReader, SaysThatXmlIsNoEds) {
  const ReadLines read("\n<?xml version=\"1.0\"?>\n<a b=\"c\"/>\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(0, 0, "xml-file")}));
}

TEST(IniReader, FindsAKeyInAnyLetterCase) {
  const ReadLines read("[1000]\nDATATYPE=7\ndatatype=8\n");
  const IniSection& section = read.ini.sections.at(0);
  ASSERT_NE(section.find("DataType"), nullptr);
  EXPECT_EQ(section.find("DataType")->value, "7");
  EXPECT_EQ(section.find("Data"), nullptr);
}

TEST(IniReader, ReadsAMillionStrayLines) {
  std::string text = "[1000]\n";
  for (int line = 0; line < 1'000'000; ++line) {
    text += "junk\n";
  }
  const ReadLines read(std::move(text));
  EXPECT_EQ(read.diagnostics.warnings(), 1'000'000U);
  EXPECT_EQ(read.diagnostics.all().size(), Diagnostics::max_per_rule);
}

TEST(IniReader, ReportsAHugeUnterminatedHeaderInAWord) {
  const ReadLines read(std::string(10'000'000, '['));
  EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(1, 1, "unterminated-section")}));
  EXPECT_LT(read.diagnostics.all().at(0).message.size(), 200U);
}

TEST(EqualIgnoringCase, FoldsAsciiLettersOnly) {
  EXPECT_TRUE(equal_ignoring_case("1a00SUB0", "1A00sub0"));
  EXPECT_FALSE(equal_ignoring_case("[", "{"));
  EXPECT_FALSE(equal_ignoring_case("Ä", "ä"));
  EXPECT_FALSE(equal_ignoring_case("a", "ab"));
}

TEST(IniReader, KeepsCommentsAndStrayLinesWithTheirPlaces) {
  const ReadLines read("; top\n[2000] ; tail\n  # a  \nstray\nDataType=5 ; no remark\n;end");
  std::vector<std::pair<std::uint32_t, std::string_view>> remarks;
  for (const IniRemark& remark : read.ini.remarks) remarks.emplace_back(remark.line, remark.text);
  const std::vector<std::pair<std::uint32_t, std::string_view>> expected = {
      {1, "; top"}, {2, "; tail"}, {3, "# a"}, {4, "stray"}, {6, ";end"}};
  EXPECT_EQ(remarks, expected);
}

}  // namespace
}  // namespace edsc
