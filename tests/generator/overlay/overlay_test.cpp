// Overlays: each change, what is reported, and where the values of the result come from.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "composed.hpp"
#include "overlay/derive_overlay.hpp"

namespace edsc {
namespace {

using Findings = std::vector<std::string>;

const std::string base = R"([FileInfo]
FileName=drive.eds

[DeviceInfo]
VendorNumber=0x1
RevisionNumber=0x01610000
BaudRate_500=1
BaudRate_800=1

[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018

[1018]
ParameterName=Identity
ObjectType=0x9
SubNumber=2

[1018sub0]
ParameterName=Highest sub-index
DataType=0x0005
AccessType=const
DefaultValue=3

[1018sub3]
ParameterName=Revision number
DataType=0x0007
AccessType=ro
DefaultValue=0x01610000

[OptionalObjects]
SupportedObjects=4
1=0x1018
2=0x1800
3=0x6041
4=0x607D

[1800]
ParameterName=TPDO 1
ObjectType=0x9
SubNumber=1

[1800sub1]
ParameterName=COB-ID
DataType=0x0007
AccessType=rw
DefaultValue=0x180 ; first

[6041]
ParameterName=Statusword
DataType=0x0006
AccessType=ro
PDOMapping=0

[607D]
ParameterName=Software position limit
ObjectType=0x8
SubNumber=2

[607Dsub0]
ParameterName=Highest sub-index
DataType=0x0005
AccessType=const
DefaultValue=1

[607Dsub1]
ParameterName=Minimum
DataType=0x0004
AccessType=rw

[ManufacturerObjects]
SupportedObjects=0x02
1=0x2000
2=0x2022

[2000]
ParameterName=Gain
DataType=0x0001
AccessType=rwr

[2022]
ParameterName=Table
ObjectType=0x8
SubNumber=3

[2022sub0]
ParameterName=Highest sub-index
DataType=0x0005
AccessType=ro
DefaultValue=10

[2022sub9]
ParameterName=Element 9
DataType=0x0005
AccessType=rwr

[2022sub10]
ParameterName=Element 10
DataType=0x0005
AccessType=ro
)";

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

/// The line of a text of the base.
std::uint32_t line_of(const std::string& part) {
  const std::size_t at = base.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return static_cast<std::uint32_t>(std::count(base.begin(), base.begin() + static_cast<std::ptrdiff_t>(at), '\n')) + 1;
}

ComposedTexts composed_with(const std::string& changes, bool needs_reasons = false) {
  return {{{"drive.eds", base}}, "[Overlay]\nVersion=1\nBase=drive.eds\n" + changes, needs_reasons};
}

std::string text_with(const std::string& changes) {
  const ComposedTexts result = composed_with(changes);
  EXPECT_EQ(result.findings(), Findings{}) << result.message();
  return result.text();
}

// The ten examples of the specification.

TEST(Overlay, ReplacesAValue) {
  EXPECT_EQ(text_with("[1018sub3]\nDefaultValue=0x01610000 => 0x01700000\n"),
            replaced(base, "DefaultValue=0x01610000", "DefaultValue=0x01700000"));
}

TEST(Overlay, RemovesAKey) {
  EXPECT_EQ(text_with("[DeviceInfo]\nBaudRate_800=1 =>\n"), replaced(base, "BaudRate_800=1\n", ""));
}

TEST(Overlay, ReplacesAValueInARange) {
  std::string changed = replaced(base, "AccessType=rwr", "AccessType=rww");
  changed = replaced(changed, "AccessType=rwr", "AccessType=rww");
  EXPECT_EQ(text_with("[2000-5FFF]\nAccessType=rwr => rww\nCount=2\n"), changed);
}

TEST(Overlay, ComparesNumbersByValue) {
  EXPECT_EQ(text_with("[2000]\nDataType=1 => 0x0005\n"), replaced(base, "DataType=0x0001", "DataType=0x0005"));
}

TEST(Overlay, MakesAnEntryMappable) {
  EXPECT_EQ(text_with("[6041]\nPDOMapping=0 => 1\n"), replaced(base, "PDOMapping=0", "PDOMapping=1"));
}

TEST(Overlay, RemovesAnObjectWithSubObjectsAndListLine) {
  const std::size_t start = base.find("[607D]");
  std::string changed = base.substr(0, start) + base.substr(base.find("[ManufacturerObjects]"));
  changed = replaced(changed, "SupportedObjects=4", "SupportedObjects=3");
  EXPECT_EQ(text_with("[607D]\nRemove=1\n"), replaced(changed, "4=0x607D\n", ""));
}

TEST(Overlay, AddsAnObjectWithListLine) {
  const std::string object = "[1017]\nParameterName=Producer heartbeat time\nDataType=0x0006\nAccessType=rw\n";
  std::string changed = replaced(base, "4\n1=0x1018\n2=0x1800\n3=0x6041\n4=0x607D\n",
                                 "5\n1=0x1017\n2=0x1018\n3=0x1800\n4=0x6041\n5=0x607D\n");
  EXPECT_EQ(text_with(object), replaced(changed, "\n[1800]", "\n" + object + "\n[1800]"));
}

TEST(Overlay, ReplacesANumberByAFormulaAndKeepsTheComment) {
  EXPECT_EQ(text_with("[1800sub1]\nDefaultValue=0x180 => $NODEID+0x180\n"),
            replaced(base, "DefaultValue=0x180 ; first", "DefaultValue=$NODEID+0x180 ; first"));
}

TEST(Overlay, AddsAKeyThatTheBaseDoesNotHave) {
  EXPECT_EQ(text_with("[6041]\nHighLimit= => 100000\n"),
            replaced(base, "AccessType=ro\nPDOMapping=0", "AccessType=ro\nHighLimit=100000\nPDOMapping=0"));
  EXPECT_EQ(text_with("[6041]\nHighLimit=100000\n"),
            replaced(base, "AccessType=ro\nPDOMapping=0", "AccessType=ro\nHighLimit=100000\nPDOMapping=0"));
}

TEST(Overlay, RenamesASubIndex) {
  EXPECT_EQ(text_with("[2022sub10]\nRename=2022subA\n"), replaced(base, "[2022sub10]", "[2022subA]"));
}

// Consistency.

TEST(Overlay, AdaptsSubNumberAndSubIndex0) {
  std::string changed = replaced(base, "\n[607Dsub1]\nParameterName=Minimum\nDataType=0x0004\nAccessType=rw\n",
                                 "\n[607Dsub1]\nParameterName=Minimum\nDataType=0x0004\nAccessType=rw\n"
                                 "\n[607Dsub2]\nParameterName=Maximum\nDataType=0x0004\nAccessType=rw\n");
  changed = replaced(changed, "ObjectType=0x8\nSubNumber=2", "ObjectType=0x8\nSubNumber=3");
  changed = replaced(changed, "DefaultValue=1\n", "DefaultValue=2\n");
  EXPECT_EQ(text_with("[607Dsub2]\nParameterName=Maximum\nDataType=0x0004\nAccessType=rw\n"), changed);
}

TEST(Overlay, RenamesAnObjectWithSubObjectsAndListLine) {
  std::string changed = replaced(base, "2=0x2022", "2=0x2040");
  for (const char* const name : {"[2022]", "[2022sub0]", "[2022sub9]", "[2022sub10]"}) {
    changed = replaced(changed, name, replaced(name, "2022", "2040"));
  }
  EXPECT_EQ(text_with("[2022]\nRename=2040\n"), changed);
}

TEST(Overlay, KeepsAStatedCount) {
  const std::string text =
      text_with("[607Dsub1]\nRemove=1\n[607D]\nSubNumber=2 => 2\n[607Dsub0]\nDefaultValue=1 => 1\n");
  EXPECT_NE(text.find("ObjectType=0x8\nSubNumber=2"), std::string::npos);
  EXPECT_EQ(text.find("[607Dsub1]"), std::string::npos);
}

TEST(Overlay, RepairsADuplicateKeyAndAMissingSection) {
  const std::string broken = "[1000]\nParameterName=a\nDataType=7\nDataType=8\n";
  const ComposedTexts result{{{"drive.eds", broken}},
                             "[Overlay]\nVersion=1\nBase=drive.eds\n[1000]\nDataType#2= =>\n"
                             "[DeviceInfo]\nVendorNumber=1\n"};
  EXPECT_EQ(result.findings(), Findings{}) << result.message();
  EXPECT_EQ(result.text(), "[DeviceInfo]\nVendorNumber=1\n\n[1000]\nParameterName=a\nDataType=7\n");
}

// Findings.

TEST(Overlay, ReportsAStaleLineWithBothValuesAndTheReason) {
  const ComposedTexts result = composed_with("; manual, page 88\n[2000]\nDataType=0x0004 => 0x0005\n");
  EXPECT_EQ(result.findings(), Findings{"overlay-stale x.overlay:6:10"});
  EXPECT_EQ(result.message(),
            "DataType of [2000] has \"0x0001\" in the base, not \"0x0004\"; reason of the change: manual, page 88");
  const std::vector<Note>& notes = result.diagnostics.all().front().notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(place_of(notes.front().position).file, "drive.eds");
  EXPECT_EQ(place_of(notes.front().position).line, line_of("DataType=0x0001"));
  EXPECT_EQ(result.text(), base);
}

TEST(Overlay, ReportsStaleLinesOfMissingParts) {
  EXPECT_EQ(composed_with("[2000]\nLowLimit=1 => 2\n").findings(), Findings{"overlay-stale x.overlay:5:10"});
  EXPECT_EQ(composed_with("[3000]\nLowLimit=1 => 2\n").findings(), Findings{"overlay-stale x.overlay:5:10"});
}

TEST(Overlay, ReportsObsoleteLines) {
  EXPECT_EQ(composed_with("[2000]\nDataType=0x0004 => 0x0001\n").findings(),
            Findings{"overlay-obsolete x.overlay:5:10"});
  EXPECT_EQ(composed_with("[2000]\nAccessType=rwr\n").findings(), Findings{"overlay-obsolete x.overlay:5:12"});
  EXPECT_EQ(composed_with("[2000]\nLowLimit=1 =>\n").findings(), Findings{"overlay-obsolete x.overlay:5:10"});
  EXPECT_EQ(composed_with("[3000]\nLowLimit=1 =>\n").findings(), Findings{"overlay-obsolete x.overlay:5:10"});
}

TEST(Overlay, ReportsAValueThatWouldOverrideUnnoticed) {
  const ComposedTexts result = composed_with("[2000]\nDataType=0x0005\n");
  EXPECT_EQ(result.findings(), Findings{"overlay-value x.overlay:5:10"});
  EXPECT_EQ(result.message(), "the base has \"0x0001\" for DataType; write DataType=0x0001 => 0x0005");
}

TEST(Overlay, ReportsChangesWithoutEffect) {
  EXPECT_EQ(composed_with("[3000]\nRemove=1\n").findings(), Findings{"overlay-effect x.overlay:5:1"});
  EXPECT_EQ(composed_with("[3000]\nRename=3001\n").findings(), Findings{"overlay-effect x.overlay:5:1"});
  EXPECT_EQ(composed_with("[3000-3FFF]\nAccessType=rwr => rww\n").findings(),
            Findings{"overlay-effect x.overlay:5:12"});
  EXPECT_EQ(composed_with("[2000-5FFF]\nAccessType=rwr => rww\nCount=3\n").findings(),
            Findings{"overlay-effect x.overlay:6:7"});
}

TEST(Overlay, ReportsTwoChangesOfOneValue) {
  EXPECT_EQ(composed_with("[2000]\nDataType=1 => 2\n[2000]\nDataType=1 => 3\n").findings(),
            Findings{"overlay-file x.overlay:7:10"});
  EXPECT_EQ(composed_with("[2000]\nAccessType=rwr => rw\n[2000-2FFF]\nAccessType=rwr => rww\n").findings(),
            Findings{"overlay-file x.overlay:7:12"});
  EXPECT_EQ(composed_with("[2022sub10]\nRename=2022sub9\n").findings(), Findings{"overlay-file x.overlay:1:1"});
}

TEST(Overlay, ReportsAMissingReasonOnlyIfItIsRequired) {
  const std::string unexplained = "\n[6041]\nPDOMapping=0 => 1\n";
  EXPECT_EQ(composed_with(unexplained).findings(), Findings{});
  EXPECT_EQ(composed_with(unexplained, true).findings(), Findings{"overlay-reason x.overlay:5:2"});
  EXPECT_EQ(composed_with("; seen in TPDO 1\n[6041]\nPDOMapping=0 => 1\n", true).findings(), Findings{});
  EXPECT_EQ(composed_with("[6041]\n; seen in TPDO 1\nPDOMapping=0 => 1\n", true).findings(), Findings{});
  EXPECT_EQ(composed_with("[6041]\nPDOMapping=0 => 1\n; too late\n", true).findings(),
            Findings{"overlay-reason x.overlay:4:2"});
}

TEST(Overlay, ReportsInvalidHeaders) {
  const auto findings = [](const std::string& header) {
    return ComposedTexts({{"drive.eds", base}}, header).findings();
  };
  EXPECT_EQ(findings("[Overlay]\nBase=drive.eds\n"), Findings{"overlay-file x.overlay:1:2"});
  EXPECT_EQ(findings("[Overlay]\nVersion=2\nBase=drive.eds\n"), Findings{"overlay-file x.overlay:2:9"});
  EXPECT_EQ(findings("[Overlay]\nVersion=1\nBase=drive.eds\nVendorNumber=1\nProductNumber=2\n"),
            Findings{"overlay-file x.overlay:3:6"});
}

// Bases.

TEST(Overlay, ReportsABaseThatCannotBeRead) {
  const ComposedTexts result{{}, "[Overlay]\nVersion=1\nBase=drive.eds\n"};
  EXPECT_EQ(result.findings(), Findings{"overlay-base x.overlay:3:6"});
  EXPECT_EQ(result.message(), "cannot read drive.eds");
  EXPECT_EQ(result.composed.text, nullptr);
}

TEST(Overlay, ReportsACircle) {
  const ComposedTexts result{{{"y.overlay", "[Overlay]\nVersion=1\nBase=x.overlay\n"}},
                             "[Overlay]\nVersion=1\nBase=y.overlay\n"};
  EXPECT_EQ(result.findings(), Findings{"overlay-base y.overlay:3:6"});
  EXPECT_EQ(result.message(), "\"x.overlay\" is based on itself");
}

std::map<std::string, std::string> chain_of(int overlays) {
  std::map<std::string, std::string> files{{"0.eds", base}};
  for (int i = 1; i <= overlays; ++i) {
    const std::string below = i == 1 ? "0.eds" : std::to_string(i - 1) + ".overlay";
    files[std::to_string(i) + ".overlay"] =
        "[Overlay]\nVersion=1\nBase=" + below +
        "\n[1018sub3]\nDefaultValue=" + (i == 1 ? "0x01610000" : std::to_string(i - 1)) + " => " + std::to_string(i) +
        "\n";
  }
  return files;
}

TEST(Overlay, HasAtMostEightBases) {
  const auto findings = [](int overlays) {
    return ComposedTexts{chain_of(overlays), "[Overlay]\nVersion=1\nBase=" + std::to_string(overlays) + ".overlay\n"}
        .findings();
  };
  EXPECT_EQ(findings(7), Findings{});
  EXPECT_EQ(findings(8), Findings{"overlay-base 1.overlay:3:6"});
}

TEST(Overlay, AppliesToAnOverlay) {
  const ComposedTexts result{chain_of(2), "[Overlay]\nVersion=1\nBase=2.overlay\n[6041]\nPDOMapping=0 => 1\n"};
  EXPECT_EQ(result.findings(), Findings{}) << result.message();
  EXPECT_EQ(result.text(),
            replaced(replaced(base, "DefaultValue=0x01610000", "DefaultValue=2"), "PDOMapping=0", "PDOMapping=1"));
  EXPECT_EQ(result.composed.parts.size(), 4U);
}

// Positions.

/// `file:line:column` of the place `offset` after the start of a text of the result.
std::string place_in(const SourceFile& text, const std::string& part, std::size_t offset = 0) {
  const std::size_t at = text.text().find(part) + offset;
  const Place place = place_of(position_at(text, at));
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

TEST(Overlay, PointsToTheFileThatAValueComesFrom) {
  const ComposedTexts result =
      composed_with("[DeviceInfo]\nBaudRate_800=1 =>\n[1018sub3]\nDefaultValue=0x01610000 => 23\n");
  const SourceFile& text = *result.composed.text;
  EXPECT_EQ(place_in(text, "=23", 1), "x.overlay:7:28");
  EXPECT_EQ(place_in(text, "DefaultValue=23"), "x.overlay:7:1");
  EXPECT_EQ(place_in(text, "[6041]"), "drive.eds:" + std::to_string(line_of("[6041]")) + ":1");
}

TEST(Overlay, PointsToTheBaseForRenumberedLines) {
  const ComposedTexts result = composed_with("[1800]\nRemove=1\n");
  EXPECT_EQ(place_in(*result.composed.text, "0x607D"), "drive.eds:" + std::to_string(line_of("4=0x607D")) + ":3");
}

TEST(Overlay, PointsToTheOverlayForAddedSections) {
  const ComposedTexts result = composed_with("[2001]\nParameterName=Added\n");
  EXPECT_EQ(place_in(*result.composed.text, "Added"), "x.overlay:5:15");
  EXPECT_EQ(place_in(*result.composed.text, "[2001]", 1), "x.overlay:4:2");
}

// Overlays that edsc writes.

std::string derived(const std::string& edited) {
  const auto file = std::make_shared<const SourceFile>("drive.eds", base);
  const DerivedOverlay overlay = derive_overlay(file, SourceFile{"edited.eds", edited}, "drive.eds");
  EXPECT_EQ(overlay.problem, "");
  const ComposedTexts result{{{"drive.eds", base}}, overlay.text};
  EXPECT_EQ(result.findings(), Findings{}) << overlay.text;
  EXPECT_EQ(result.text(), edited) << overlay.text;
  return overlay.text.substr(overlay.text.find("\n\n") + 1);
}

TEST(DerivedOverlay, StatesValuesKeysAndSections) {
  EXPECT_EQ(derived(replaced(base, "PDOMapping=0", "PDOMapping=1")), "\n[6041]\nPDOMapping=0 => 1\n");
  EXPECT_EQ(derived(replaced(base, "BaudRate_800=1\n", "")), "\n[DeviceInfo]\nBaudRate_800=1 =>\n");
  EXPECT_EQ(derived(replaced(base, "PDOMapping=0\n", "PDOMapping=0\nUnit=1\n")), "\n[6041]\nUnit=1\n");
}

TEST(DerivedOverlay, StatesAListOnlyIfItDoesNotFollow) {
  const std::string unlisted = replaced(base, "3=0x1018\n", "");
  EXPECT_EQ(derived(unlisted),
            "\n[MandatoryObjects]\nSupportedObjects=3 => 3\n1=0x1000 => 0x1000\n"
            "2=0x1001 => 0x1001\n3=0x1018 =>\n");
  const std::size_t start = base.find("[607D]");
  std::string without = base.substr(0, start) + base.substr(base.find("[ManufacturerObjects]"));
  without = replaced(replaced(without, "SupportedObjects=4", "SupportedObjects=3"), "4=0x607D\n", "");
  EXPECT_EQ(derived(without), "\n[607D]\nRemove=1\n");
}

TEST(DerivedOverlay, ListsAddedObjectsInANewList) {
  const auto file = std::make_shared<const SourceFile>("drive.eds", "[1000]\nDataType=7\n");
  const SourceFile edited{"edited.eds", "[1000]\nDataType=7\n[2000]\nDataType=5\n"};
  const DerivedOverlay overlay = derive_overlay(file, edited, "drive.eds");
  EXPECT_EQ(overlay.problem, "");
  EXPECT_EQ(overlay.text, "[Overlay]\nVersion=1\nBase=drive.eds\n\n[2000]\nDataType=5\n");
}

TEST(DerivedOverlay, NamesWhatAnOverlayCannotExpress) {
  const auto file = std::make_shared<const SourceFile>("drive.eds", base);
  const std::string edited =
      replaced(base, "[607D]\nParameterName=Software position limit\nObjectType=0x8\nSubNumber=2\n", "");
  EXPECT_NE(derive_overlay(file, SourceFile{"edited.eds", edited}, "drive.eds").problem, "");
}

TEST(RebasedOverlay, DropsObsoleteLinesAndKeepsTheRest) {
  const std::string text =
      "; corrections\n[Overlay]\nVersion=1\nBase=old.eds\n\n; known\n[2000]\nDataType=4 => 1\n\n; mappable\n[6041]\n"
      "PDOMapping=0 => 1\nDataType=5 => 6\n\n; wrong\n[1800]\nSubNumber=7 => 8\n";
  const auto file = std::make_shared<const SourceFile>("x.overlay", text);
  const SourceFile new_base{"drive.eds", base};
  Diagnostics diagnostics;
  const OverlayFile overlay = read_overlay(*file, diagnostics);
  const OverlayEdits edits = edits_of(overlay, SheetText{new_base}, false, diagnostics);
  std::vector<LineState> states;
  for (const LineOutcome& outcome : edits.outcomes) states.push_back(outcome.state);
  EXPECT_EQ(states, (std::vector{LineState::obsolete, LineState::applied, LineState::obsolete, LineState::stale}));
  EXPECT_EQ(rebased_overlay(overlay, text, edits.outcomes, "drive.eds").bytes,
            "; corrections\n[Overlay]\nVersion=1\nBase=drive.eds\n\n; mappable\n[6041]\nPDOMapping=0 => 1\n\n"
            "; wrong\n[1800]\nSubNumber=7 => 8\n");
}

}  // namespace
}  // namespace edsc
