// Changes of an EDS: what they write, what follows from them, and why they are rejected.
#include "change/apply_changes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "change/line_diff.hpp"

namespace edsc {
namespace {

constexpr const char* small_eds = R"([FileInfo]
FileName=a.eds
FileRevision=3
[DeviceInfo]
VendorName=Acme
VendorNumber=0x1
ProductNumber=2
RevisionNumber=0x00010000
NrOfRXPDO=0
NrOfTXPDO=0
[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018
[1000]
ParameterName=Device type
ObjectType=7
DataType=0x0007
AccessType=ro
DefaultValue=0
[1001]
ParameterName=Error register
ObjectType=7
DataType=5
AccessType=ro
[1018]
ParameterName=Identity
ObjectType=9
SubNumber=2
[1018sub0]
ParameterName=Highest sub-index
DataType=5
AccessType=ro
DefaultValue=1
[1018sub1]
ParameterName=Vendor-ID
DataType=7
AccessType=ro
DefaultValue=1 ; assigned by CiA
[ManufacturerObjects]
SupportedObjects=1
1=0x2000
[2000]
ParameterName=Speed
ObjectType=7
DataType=0x0006
AccessType=rww
DefaultValue=0x0010
PDOMapping=1
)";

std::unique_ptr<OpenSheet> open(const std::string& bytes) { return open_sheet("a.eds", bytes, {}, SheetChecks::all); }

AppliedChanges apply(const std::string& bytes, const std::vector<SheetChange>& changes, ChangeSettings settings = {}) {
  const auto before = open(bytes);
  AppliedChanges applied = apply_changes(*before, changes, settings);
  if (!applied.is_rejected) {
    EXPECT_EQ(with_edits(bytes, applied.bytes), applied.after->bytes);
    EXPECT_EQ(without_edits(applied.after->bytes, applied.bytes), bytes);
  }
  return applied;
}

/// The bytes after changes that must be possible.
std::string changed(const std::string& bytes, const std::vector<SheetChange>& changes, ChangeSettings settings = {}) {
  const AppliedChanges applied = apply(bytes, changes, settings);
  EXPECT_EQ(applied.problem, "");
  EXPECT_FALSE(applied.is_rejected) << (applied.new_errors.empty() ? "" : applied.new_errors.front().message);
  return applied.is_rejected ? "" : applied.after->bytes;
}

std::string replaced(std::string text, const std::string& before, const std::string& after) {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  return text.replace(at, before.size(), after);
}

TEST(ApplyChanges, KeepsTheNotationOfANumber) {
  EXPECT_EQ(changed(small_eds, {SetValue{"2000", "DefaultValue", "32"}}),
            replaced(small_eds, "DefaultValue=0x0010", "DefaultValue=0x0020"));
  EXPECT_EQ(changed(small_eds, {SetValue{"1000", "datatype", "7h"}}), small_eds);
  const std::string formula = replaced(small_eds, "DefaultValue=0x0010", "DefaultValue=0x10 + $NodeId ; id");
  EXPECT_EQ(changed(formula, {SetValue{"2000", "DefaultValue", "$NODEID+0x20"}}),
            replaced(small_eds, "DefaultValue=0x0010", "DefaultValue=0x20 + $NodeId ; id"));
}

TEST(ApplyChanges, KeepsTheTextOfAString) {
  const std::string text =
      replaced(replaced(small_eds, "0x0006\nAccessType=rww", "0x0009\nAccessType=ro"), "0x0010", "10");
  EXPECT_EQ(changed(replaced(text, "PDOMapping=1", "PDOMapping=0"), {SetValue{"2000", "DefaultValue", "0x20;a"}}),
            replaced(replaced(text, "PDOMapping=1", "PDOMapping=0"), "DefaultValue=10", "DefaultValue=0x20;a"));
}

TEST(ApplyChanges, SetsTheIdentityInBothPlaces) {
  const std::string both =
      replaced(replaced(small_eds, "VendorNumber=0x1", "VendorNumber=0x5"), "DefaultValue=1 ;", "DefaultValue=5 ;");
  EXPECT_EQ(changed(small_eds, {SetValue{"DeviceInfo", "VendorNumber", "5"}}), both);
  EXPECT_EQ(changed(small_eds, {SetValue{"1018sub1", "DefaultValue", "0x5"}}), both);
}

TEST(ApplyChanges, AddsASubObjectWithItsCounts) {
  const AddSections serial{
      {{"1018sub2", {{"DataType", "7"}, {"ParameterName", "Product code"}, {"AccessType", "ro"}}}}};
  const std::string after = changed(small_eds, {serial});
  EXPECT_EQ(after, replaced(replaced(replaced(small_eds, "SubNumber=2", "SubNumber=3"), "DefaultValue=1\n",
                                     "DefaultValue=2\n"),
                            "assigned by CiA\n",
                            "assigned by CiA\n[1018sub2]\nParameterName=Product code\nDataType=7\nAccessType=ro\n"));
}

TEST(ApplyChanges, AddsAListedObject) {
  const AddSections heartbeat{
      {{"1017", {{"ParameterName", "Heartbeat"}, {"ObjectType", "7"}, {"DataType", "6"}, {"AccessType", "rw"}}}}};
  const std::string after = changed(small_eds, {heartbeat});
  EXPECT_NE(after.find("[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n"), std::string::npos) << after;
  EXPECT_NE(after.find("[1017]\nParameterName=Heartbeat\n"), std::string::npos);
}

TEST(ApplyChanges, RenamesAnObjectWithThePdosThatMapIt) {
  MapPdo map{PdoDirection::receive, 1, std::vector{MappingValue{0x2000, 0, 16}}, {}, {}, {}, {}, {}};
  const std::string mapped = changed(small_eds, {map});
  EXPECT_NE(mapped.find("NrOfRXPDO=1\n"), std::string::npos);
  EXPECT_NE(mapped.find("DefaultValue=$NODEID+0x200\n"), std::string::npos);
  const std::string renamed = changed(mapped, {RenamePart{"2000", "", "2100"}});
  EXPECT_EQ(renamed, replaced(replaced(replaced(mapped, "1=0x2000", "1=0x2100"), "[2000]", "[2100]"), "0x20000010",
                              "0x21000010"));
}

TEST(ApplyChanges, RejectsTheRemovalOfAMappedObject) {
  MapPdo map{PdoDirection::receive, 1, std::vector{MappingValue{0x2000, 0, 16}}, {}, {}, {}, {}, {}};
  const std::string mapped = changed(small_eds, {map});
  const AppliedChanges applied = apply(mapped, {RemovePart{"2000", ""}});
  EXPECT_TRUE(applied.is_rejected);
  EXPECT_EQ(applied.objections, std::vector<std::string>{"2000h:00 is mapped by RPDO 1"});
  EXPECT_TRUE(applied.edits.empty());
  EXPECT_FALSE(apply(mapped, {RemovePart{"2000", ""}}, {.force = true}).is_rejected);
  map.objects->clear();
  EXPECT_EQ(changed(mapped, {map, RemovePart{"2000", ""}}).find("[2000]"), std::string::npos);
}

TEST(ApplyChanges, RejectsNewErrors) {
  const AppliedChanges applied = apply(small_eds, {SetValue{"2000", "DefaultValue", "much"}});
  EXPECT_TRUE(applied.is_rejected);
  ASSERT_EQ(applied.new_errors.size(), 1U);
  const AppliedChanges forced = apply(small_eds, {SetValue{"2000", "DefaultValue", "much"}}, {.force = true});
  EXPECT_FALSE(forced.is_rejected);
  // The error is not a new one any more.
  EXPECT_FALSE(apply(forced.after->bytes, {SetValue{"2000", "ParameterName", "a"}}).is_rejected);
}

/// One error less of a rule does not make up for another one.
TEST(ApplyChanges, RejectsAnErrorThatReplacesAnotherOne) {
  const AppliedChanges broken = apply(small_eds, {SetValue{"2000", "DataType", "0x99"}}, {.force = true});
  ASSERT_EQ(broken.new_errors.size(), 1U);
  EXPECT_TRUE(apply(broken.after->bytes, {SetValue{"2000", "DataType", "0x98"}}).is_rejected);
  EXPECT_FALSE(apply(broken.after->bytes, {SetValue{"2000", "DataType", "0x0006"}}).is_rejected);
}

TEST(ApplyChanges, RejectsWhatAFileCannotHave) {
  EXPECT_EQ(apply(small_eds, {SetValue{"2001", "DefaultValue", "1"}}).problem, "section [2001] is missing");
  EXPECT_EQ(apply(small_eds, {SetValue{"2000", "ParameterName", "a\nb"}}).problem,
            "ParameterName of [2000] cannot have a text with a control character");
  EXPECT_EQ(apply(small_eds, {SetValue{"2000", "a=b", "1"}}).problem, "a=b cannot be a key");
  EXPECT_EQ(apply(small_eds, {AddSections{{{"2000", {}}}}}).problem, "section [2000] already exists");
  EXPECT_EQ(apply(small_eds, {RenamePart{"2000", "", "1000"}}).problem, "section [1000] already exists");
  EXPECT_EQ(apply(small_eds, {RemovePart{"2000", "HighLimit"}}).problem, "[2000] does not have a key HighLimit");
  EXPECT_NE(apply(small_eds, {SetValue{"2000", "ParameterName", "\xC2\xB0"}}).problem.find("--utf8"),
            std::string::npos);
  EXPECT_FALSE(apply(small_eds, {SetValue{"2000", "ParameterName", "\xC2\xB0"}}, {.utf8 = true}).is_rejected);
}

TEST(ApplyChanges, StampsAFile) {
  const std::string after =
      changed(small_eds, {SetValue{"2000", "ParameterName", "b"}}, {.stamp = ChangeStamp{"11-29-2026", "12:00AM"}});
  EXPECT_NE(after.find("FileRevision=4\n"), std::string::npos);
  EXPECT_NE(after.find("ModificationTime=12:00AM\nModificationDate=11-29-2026\n"), std::string::npos) << after;
}

TEST(ApplyChanges, KeepsTheOtherBytes) {
  const std::string bytes =
      "\xEF\xBB\xBF; a\r\n[2000]\r\n ParameterName = a\rDataType=6 ; c\n\nother\n[Vendor]\nx=1\n[2001]";
  EXPECT_EQ(changed(bytes, {SetValue{"2000", "ParameterName", "b"}}, {.force = true}), replaced(bytes, "= a", "= b"));
  EXPECT_EQ(changed(bytes, {RemovePart{"Vendor", ""}}, {.force = true}), replaced(bytes, "[Vendor]\nx=1\n", ""));
}

TEST(ApplyChanges, HasAJsonForm) {
  const std::vector<SheetChange> changes = {
      SetValue{"2000", "DefaultValue", "5"},
      SetValue{"2000", "DefaultValue", ""},
      RemovePart{"2000", ""},
      RemovePart{"2000", "HighLimit"},
      RenamePart{"2000", "", "2001"},
      AddSections{{{"2000", {{"DataType", "6"}, {"ParameterName", "a"}}}}},
      MapPdo{PdoDirection::receive, 260, std::vector{MappingValue{0x6040, 0, 16}}, "$NODEID+0x200", 255, {}, 100, {}},
      MapPdo{PdoDirection::transmit, 1, std::vector<MappingValue>{}, {}, {}, 20, {}, 3}};
  for (const SheetChange& change : changes) {
    std::string problem;
    const auto read = read_change(nlohmann::json::parse(change_as_json(change).dump()), problem);
    EXPECT_EQ(problem, "");
    EXPECT_EQ(read, change) << change_as_json(change);
  }
  EXPECT_EQ(change_as_json(changes[6]).dump(),
            R"({"do":"map","direction":"receive","number":260,"objects":["60400010h"],"cob_id":"$NODEID+0x200",)"
            R"("transmission_type":255,"event_timer":100})");
}

TEST(ApplyChanges, ReportsWrongJson) {
  const auto problem_of = [](const char* text) {
    std::string problem;
    EXPECT_FALSE(read_change(nlohmann::json::parse(text), problem));
    return problem;
  };
  EXPECT_NE(problem_of("[]"), "");
  EXPECT_NE(problem_of(R"({"do":"erase"})").find("\"do\""), std::string::npos);
  EXPECT_EQ(problem_of(R"({"do":"set","section":"2000","key":"a"})"), "missing member \"value\"");
  EXPECT_EQ(problem_of(R"({"do":"remove","section":7})"), "invalid value of \"section\": 7");
  EXPECT_EQ(problem_of(R"({"do":"remove","section":"7","x":1})"), "unknown member of a change \"remove\"");
  EXPECT_EQ(problem_of(R"({"do":"map","direction":"transmit","number":70000})"), "invalid value of \"number\": 70000");
  EXPECT_NE(problem_of(R"({"do":"map","direction":"transmit","number":1,"objects":["6041"]})"), "");
}

TEST(LineDiff, FindsTheShortestEdits) {
  const SourceFile before{"a", "[a]\nx=1\n\n[b]\ny=1\n\n[c]\nz=1\n"};
  const SourceFile after{"a", "[a]\nx=1\n\n[c]\nz=2\n\n[d]\n"};
  const std::vector<TextEdit> edits = line_edits(before, after);
  EXPECT_EQ(unified_diff(before, edits, "a"),
            "--- a\n+++ a\n@@ -1,8 +1,7 @@\n [a]\n x=1\n \n-[b]\n-y=1\n-\n [c]\n-z=1\n+z=2\n+\n+[d]\n");
  EXPECT_EQ(edited_bytes(before.text(), Encoding::ascii, edits, false).bytes, after.text());
  EXPECT_TRUE(line_edits(before, before).empty());
}

}  // namespace
}  // namespace edsc
