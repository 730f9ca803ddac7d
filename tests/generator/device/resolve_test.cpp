#include "device/resolve.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataType;
using Rules = std::vector<std::string>;

/// `[2000sub1]` and its keys.
std::string sub(std::string_view index, int number, std::string_view name, std::string_view data_type,
                std::string_view more = "") {
  return var(std::string{index} + "sub" + std::to_string(number), name, data_type, "rw", more);
}

// ---- types ----

TEST(Resolve, KnowsEveryBasicDataType) {
  for (const canopen::DataTypeRow& row : canopen::data_types) {
    const std::string code = std::to_string(static_cast<int>(row.type));
    const DeviceFromText text(var("2000", "Value", code));
    EXPECT_EQ(text.entry(0x2000).type, &row) << row.name;
    EXPECT_EQ(rules_of(text.diagnostics), Rules{}) << row.name;
  }
}

TEST(Resolve, MakesADomainOfAnObjectOfAnUnknownDataType) {
  const DeviceFromText text(var("2000", "Value", "0x0040", "rw", "DefaultValue=5\n"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::domain);
  EXPECT_FALSE(text.entry(0x2000).default_value);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"data-type"});
  EXPECT_EQ(findings(text.diagnostics, "data-type"), (std::vector{error_at(4, 10, "data-type")}));
}

TEST(Resolve, LeavesOutWhatServicesNeedOfAnUnknownDataType) {
  EXPECT_EQ(DeviceFromText(var("1017", "Producer heartbeat time", "0x0040")).device.find(0x1017), nullptr);
  const DeviceFromText text(group("2000", "Record", "0x9", 2) + var("2000sub0", "Count", "0x0040", "ro") +
                            var("2000sub1", "Value", "0x0040"));
  EXPECT_EQ(text.entry(0x2000, 0).type->type, DataType::unsigned8) << "supplied";
  EXPECT_EQ(text.entry(0x2000, 1).type->type, DataType::domain);
}

TEST(Resolve, MakesADomainOfAnObjectWithoutDataType) {
  const DeviceFromText text("[2000]\nParameterName=Value\nObjectType=7\nAccessType=rw\n");
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::domain);
  EXPECT_EQ(findings(text.diagnostics, "data-type"), (std::vector{error_at(1, 2, "data-type")}));
}

TEST(Resolve, WantsANumberForDataType) {
  const DeviceFromText text(var("2000", "Value", "UNSIGNED8"));
  EXPECT_EQ(findings(text.diagnostics, "data-type"), (std::vector{error_at(4, 10, "data-type")}));
}

TEST(Resolve, LeavesAnEntryOfAComplexTypeOutWithAWarning) {
  const DeviceFromText text(var("2000", "Value", "0x0021"));
  EXPECT_EQ(text.device.find(0x2000), nullptr);
  EXPECT_EQ(findings(text.diagnostics, "complex-data-type"), (std::vector{warning_at(4, 10, "complex-data-type")}));
}

TEST(Resolve, FollowsADeftypeToItsBasicType) {
  const DeviceFromText text(
      "[0040]\nParameterName=Speed\nObjectType=0x5\nDataType=0x0041\nAccessType=const\n"
      "[0041]\nParameterName=Base\nObjectType=0x5\nDataType=0x0004\nAccessType=const\n" +
      var("2000", "Target", "0x0040"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::integer32);
  EXPECT_EQ(text.device.find(0x40), nullptr) << "a type is not part of the dictionary";
  EXPECT_EQ(text.device.types.size(), 2U);
  EXPECT_EQ(text.diagnostics.errors(), 0U);
}

/// `[0042]`: a DEFTYPE whose value is its length in bits.
std::string deftype(std::string_view index, std::string_view data_type, std::string_view bits) {
  return "[" + std::string{index} + "]\nParameterName=Own\nObjectType=0x5\nDataType=" + std::string{data_type} +
         "\nAccessType=ro\nDefaultValue=" + std::string{bits} + "\n";
}

TEST(Resolve, TakesADeftypeOfAnotherLengthForOctets) {
  const DeviceFromText text(deftype("0042", "7", "2048") + var("2000", "Image", "0x42"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::octet_string);
  EXPECT_EQ(text.entry(0x2000).octets, 256U);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"type-length"});
  EXPECT_EQ(text.finding("type-length").severity, Severity::note);
  EXPECT_EQ(text.line_of("type-length"), "DefaultValue=2048");
}

TEST(Resolve, ReadsTheLengthThatADeftypeStates) {
  struct Row {
    std::string_view data_type, bits;
    DataType type;
    std::uint32_t octets;
  };
  const Row rows[] = {
      {"7", "32", DataType::unsigned32, 0},     {"6", "16", DataType::unsigned16, 0},
      {"5", "8", DataType::unsigned8, 0},       {"4", "0x20", DataType::integer32, 0},
      {"7", "0", DataType::unsigned32, 0},      {"7", "", DataType::unsigned32, 0},
      {"7", "24", DataType::octet_string, 3},   {"9", "160", DataType::visible_string, 20},
      {"0xA", "64", DataType::octet_string, 8}, {"0xF", "0x8000", DataType::domain, 0},
      {"7", "2056", DataType::domain, 0},       {"7", "20", DataType::domain, 0},
  };
  for (const Row& row : rows) {
    const DeviceFromText text(deftype("0042", row.data_type, row.bits) + var("2000", "Value", "0x42"));
    EXPECT_EQ(text.entry(0x2000).type->type, row.type) << row.data_type << " of " << row.bits;
    EXPECT_EQ(text.entry(0x2000).octets, row.octets) << row.data_type << " of " << row.bits;
    const Rules rules = rules_of(text.diagnostics);
    EXPECT_TRUE(rules.empty() || rules == Rules{"type-length"}) << row.data_type << " of " << row.bits;
  }
}

TEST(Resolve, KeepsABasicTypeThatASheetDescribesAsDeftype) {
  const DeviceFromText text(deftype("0007", "7", "1") + var("2000", "Value", "7"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::unsigned32);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, RefusesADefaultThatIsLongerThanItsDeftype) {
  const std::string type = deftype("0042", "9", "32");
  const DeviceFromText fits(type + var("2000", "Label", "0x42", "rw", "DefaultValue=four\n"));
  EXPECT_EQ(rules_of(fits.diagnostics), Rules{});
  const DeviceFromText text(type + var("2000", "Label", "0x42", "rw", "DefaultValue=five5\n"));
  EXPECT_EQ(text.finding("number-range").severity, Severity::error);
  EXPECT_EQ(text.line_of("number-range"), "DefaultValue=five5");
  EXPECT_FALSE(text.entry(0x2000).default_value);
}

TEST(Resolve, TakesTheNameOfAnObjectTypeForItsNumber) {
  const DeviceFromText text("[2000]\nParameterName=Value\nObjectType=var\nDataType=5\nAccessType=rw\n");
  EXPECT_EQ(text.device.find(0x2000)->type, ObjectType::var);
  EXPECT_EQ(text.finding("object-type").message, "ObjectType must be a number; that of VAR is 0x7");
}

TEST(Resolve, FollowsADeftypeToOneThatStatesALength) {
  const DeviceFromText text(deftype("0042", "7", "2048") + deftype("0043", "0x42", "0") + var("2000", "Image", "0x43"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::octet_string);
  EXPECT_EQ(text.entry(0x2000).octets, 256U);
}

TEST(Resolve, MapsAnObjectOfTheLengthThatItsDeftypeStates) {
  const DeviceFromText text(deftype("0042", "7", "40") + var("2000", "Image", "0x42", "ro", "PDOMapping=1\n") +
                            group("1800", "Communication", "9", 3) + sub("1800", 0, "Count", "5", "DefaultValue=2\n") +
                            sub("1800", 1, "COB-ID", "7", "DefaultValue=0x181\n") + sub("1800", 2, "Type", "5") +
                            group("1A00", "Mapping", "9", 2) + sub("1A00", 0, "Count", "5", "DefaultValue=1\n") +
                            sub("1A00", 1, "Entry", "7", "DefaultValue=0x20000028\n"));
  EXPECT_FALSE(text.device.pdos.at(0).broken);
  EXPECT_EQ(text.diagnostics.errors(), 0U);
}

TEST(Resolve, EndsWhenDeftypesNameEachOther) {
  const DeviceFromText text(
      "[0040]\nParameterName=A\nObjectType=0x5\nDataType=0x0041\n"
      "[0041]\nParameterName=B\nObjectType=0x5\nDataType=0x0040\n" +
      var("2000", "Target", "0x0040"));
  EXPECT_EQ(text.finding("data-type").severity, Severity::error);
}

TEST(Resolve, TakesTheLimitsOfADeftypeWhereAnEntryHasNone) {
  const DeviceFromText text(
      "[0040]\nParameterName=Percent\nObjectType=0x5\nDataType=0x0003\nLowLimit=-100\nHighLimit=100\n" +
      var("2000", "Load", "0x40") + var("2001", "Torque", "0x40", "rw", "HighLimit=50\n"));
  EXPECT_EQ(static_cast<std::int64_t>(text.entry(0x2000).low_limit->bits), -100);
  EXPECT_EQ(text.entry(0x2000).high_limit->bits, 100U);
  EXPECT_EQ(text.entry(0x2001).high_limit->bits, 50U);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, ReadsARangeTypeAsCanFestivalWritesIt) {
  const DeviceFromText text(
      group("00A0", "UNSIGNED16[5-60]", "0x9", 4) + sub("00A0", 0, "Count", "5") +
      sub("00A0", 1, "Type", "5", "DefaultValue=6\n") + sub("00A0", 2, "Minimum Value", "6", "DefaultValue=5\n") +
      sub("00A0", 3, "Maximum Value", "6", "DefaultValue=0x3C\n") + var("2000", "Speed", "0x00A0"));
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::unsigned16);
  EXPECT_EQ(text.entry(0x2000).low_limit->bits, 5U);
  EXPECT_EQ(text.entry(0x2000).high_limit->bits, 60U);
  ASSERT_EQ(text.device.types.size(), 1U);
  EXPECT_EQ(text.device.types[0].name, "UNSIGNED16[5-60]");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, GivesTheMembersOfADefstructToARecordOfItsType) {
  const DeviceFromText text(group("0060", "Axis", "0x6", 3) + sub("0060", 0, "Count", "5", "DefaultValue=2\n") +
                            sub("0060", 1, "Position", "6", "DefaultValue=0x0004\n") +
                            sub("0060", 2, "Speed", "6", "DefaultValue=0x0003\n") + group("2000", "X axis", "0x9", 3) +
                            "DataType=0x0060\n" + sub("2000", 0, "Count", "5") +
                            "[2000sub1]\nParameterName=Position\nAccessType=rw\n"
                            "[2000sub2]\nParameterName=Speed\nAccessType=rw\n");
  EXPECT_EQ(text.entry(0x2000, 1).type->type, DataType::integer32);
  EXPECT_EQ(text.entry(0x2000, 2).type->type, DataType::integer16);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, GivesTheMembersOfAPredefinedRecordToOneOfItsType) {
  const DeviceFromText text(group("1018", "Identity object", "0x9", 2) + "DataType=0x0023\n" +
                            sub("1018", 0, "Count", "5", "DefaultValue=1\n") +
                            "[1018sub1]\nParameterName=Vendor-ID\nAccessType=ro\n");
  EXPECT_EQ(text.entry(0x1018, 1).type->type, DataType::unsigned32);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, TakesTheMembersTypeForASubObjectOfTheRecordsType) {
  const DeviceFromText text(group("1018", "Identity object", "0x9", 2) + sub("1018", 0, "Count", "5") +
                            sub("1018", 1, "Vendor-ID", "0x0023"));
  EXPECT_EQ(text.entry(0x1018, 1).type->type, DataType::unsigned32);
  EXPECT_EQ(findings(text.diagnostics, "complex-data-type").size(), 1U);
}

TEST(Resolve, WarnsOfATypeThatStandsForNone) {
  const DeviceFromText text("[0040]\nParameterName=A\nObjectType=0x5\nDataType=0x0041\n" + var("2000", "V", "5"));
  EXPECT_EQ(findings(text.diagnostics, "type-definition"), (std::vector{warning_at(4, 10, "type-definition")}));
}

TEST(Resolve, TakesATypeBeyond1000hForAValue) {
  const DeviceFromText text("[2000]\nParameterName=A\nObjectType=0x5\nDataType=0x0005\nAccessType=ro\n");
  EXPECT_EQ(text.device.find(0x2000)->type, ObjectType::var);
  EXPECT_EQ(findings(text.diagnostics, "object-type"), (std::vector{warning_at(3, 12, "object-type")}));
}

TEST(Resolve, ReadsAnIndexOfFewerDigitsAndAZeroPaddedSubIndex) {
  const DeviceFromText text(group("2000", "Group", "0x9", 2) + sub("2000", 0, "Count", "5") +
                            var("2000Sub01", "One", "6") + "[40]\nParameterName=T\nObjectType=5\nDataType=5\n");
  EXPECT_EQ(text.entry(0x2000, 1).name, "One");
  EXPECT_EQ(text.device.types.at(0).index, 0x40);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"section-name"});
}

TEST(Resolve, CutsCommentsBehindNumbersAndKeepsThemInTexts) {
  const DeviceFromText text(
      "[2000]\nParameterName=Limit #1; upper\nObjectType=0x07 # VAR\nDataType=0x0006 ; two bytes\n"
      "AccessType=rw;\nDefaultValue=0x3ED ; homing\nPDOMapping=0 # No\n" +
      var("2001", "Text", "9", "ro", "DefaultValue=a;b #c\n"));
  EXPECT_EQ(text.entry(0x2000).name, "Limit #1; upper");
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 0x3EDU);
  EXPECT_EQ(text.entry(0x2001).default_value->bytes, "a;b #c");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, TakesADomainByItsObjectTypeWithoutDataType) {
  const DeviceFromText text("[2000]\nParameterName=Program\nObjectType=0x2\nAccessType=rw\n");
  EXPECT_EQ(text.entry(0x2000).type->type, DataType::domain);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"data-type"});
  EXPECT_EQ(text.diagnostics.errors(), 0U);
}

// ---- object types ----

TEST(Resolve, TakesAnObjectWithoutObjectTypeForAVar) {
  const DeviceFromText text("[2000]\nParameterName=Value\nDataType=5\nAccessType=ro\n");
  EXPECT_EQ(text.device.find(0x2000)->type, ObjectType::var);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Resolve, TakesAVarWithSubObjectsForARecord) {
  const std::string subs = sub("2000", 0, "Count", "5") + sub("2000", 1, "One", "5");
  const DeviceFromText announced(var("2000", "Value", "5", "rw", "SubNumber=2\n") + subs);
  EXPECT_EQ(announced.device.find(0x2000)->type, ObjectType::record);
  EXPECT_EQ(findings(announced.diagnostics, "object-type"), (std::vector{warning_at(3, 12, "object-type")}));
  const DeviceFromText untyped("[2000]\nParameterName=Value\nObjectType=7\n" + subs);
  EXPECT_EQ(untyped.device.find(0x2000)->type, ObjectType::record);
  EXPECT_EQ(findings(untyped.diagnostics, "object-type"), (std::vector{warning_at(3, 12, "object-type")}));
}

TEST(Resolve, KeepsAVarThatASubObjectOfAnotherIndexStraysInto) {
  const DeviceFromText text(var("1017", "Heartbeat", "6", "rw", "DefaultValue=500\n") + "[1017sub4]\n" +
                            "ParameterName=Serial number\nObjectType=7\nDataType=7\nAccessType=ro\n");
  EXPECT_EQ(text.device.find(0x1017)->type, ObjectType::var);
  EXPECT_EQ(text.entry(0x1017).type->type, DataType::unsigned16);
  EXPECT_EQ(text.entry(0x1017).default_value.value().bits, 500U);
  EXPECT_EQ(text.device.find(0x1017)->entries.size(), 1U);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"sub-object-without-object"});
  EXPECT_EQ(text.line_of("sub-object-without-object"), "[1017sub4]");
  EXPECT_NE(text.finding("sub-object-without-object").message.find("1017h:04 \"Serial number\" is left out"),
            std::string::npos);
}

TEST(Resolve, TakesAVarWithSubIndex0ForARecord) {
  const std::string sub = "ParameterName=Part\nObjectType=7\nDataType=7\nAccessType=ro\n";
  const DeviceFromText text(var("1018", "Identity", "7", "ro") + "[1018sub0]\n" + sub + "[1018sub1]\n" + sub);
  EXPECT_EQ(text.device.find(0x1018)->type, ObjectType::record);
  EXPECT_EQ(text.device.find(0x1018)->entries.size(), 2U);
}

TEST(Resolve, TakesAnUnknownObjectTypeForWhatItLooksLike) {
  const DeviceFromText text("[2000]\nParameterName=Value\nObjectType=99\nDataType=5\nAccessType=ro\n");
  EXPECT_EQ(text.device.find(0x2000)->type, ObjectType::var);
  EXPECT_EQ(findings(text.diagnostics, "object-type"), (std::vector{warning_at(3, 12, "object-type")}));
}

TEST(Resolve, LeavesARecordWithoutSubObjectsOut) {
  const DeviceFromText text(group("2000", "Empty", "0x9", 0));
  EXPECT_EQ(text.device.find(0x2000), nullptr);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{"no-sub-objects"});
}

// ---- missing keys ----

TEST(Resolve, TakesAMissingAccessTypeForRw) {
  const DeviceFromText text("[2000]\nParameterName=Value\nObjectType=7\nDataType=5\n");
  EXPECT_EQ(text.entry(0x2000).access, Access::rw);
  EXPECT_EQ(findings(text.diagnostics, "access-type"), (std::vector{warning_at(1, 2, "access-type")}));
}

TEST(Resolve, ReadsEveryAccessTypeInAnyLetterCase) {
  for (const canopen::AccessRow& row : canopen::access_rows) {
    EXPECT_EQ(DeviceFromText(var("2000", "Value", "5", row.name)).entry(0x2000).access, row.access) << row.name;
  }
  EXPECT_EQ(DeviceFromText(var("2000", "Value", "5", "CONST")).entry(0x2000).access, Access::constant);
}

TEST(Resolve, RejectsAnUnknownAccessType) {
  const DeviceFromText text(var("2000", "Value", "5", "sometimes"));
  EXPECT_EQ(findings(text.diagnostics, "access-type"), (std::vector{error_at(5, 12, "access-type")}));
}

TEST(Resolve, TakesAMissingPdoMappingForNone) {
  EXPECT_FALSE(DeviceFromText(var("2000", "Value", "5")).entry(0x2000).pdo_mapping);
  EXPECT_TRUE(DeviceFromText(var("2000", "Value", "5", "rw", "PDOMapping=1\n")).entry(0x2000).pdo_mapping);
}

TEST(Resolve, TakesAnyOtherPdoMappingNumberForOneWithAWarning) {
  const DeviceFromText text(var("2000", "Value", "5", "rw", "PDOMapping=2\n"));
  EXPECT_TRUE(text.entry(0x2000).pdo_mapping);
  EXPECT_EQ(findings(text.diagnostics, "pdo-mapping"), (std::vector{warning_at(6, 12, "pdo-mapping")}));
  EXPECT_FALSE(DeviceFromText(var("2000", "Value", "5", "rw", "PDOMapping=optional\n")).entry(0x2000).pdo_mapping);
}

TEST(Resolve, NamesAnObjectWithoutParameterNameByItsIndex) {
  const DeviceFromText text(var("2000", "", "5"));
  EXPECT_EQ(text.device.find(0x2000)->identifier, "object_2000");
  EXPECT_EQ(findings(text.diagnostics, "parameter-name"), (std::vector{warning_at(1, 2, "parameter-name")}));
}

TEST(Resolve, SuppliesAMissingSubIndex0) {
  const DeviceFromText text(group("2000", "Group", "0x9", 1) + sub("2000", 3, "Three", "7"));
  const Entry& count = text.entry(0x2000, 0);
  EXPECT_EQ(count.type->type, DataType::unsigned8);
  EXPECT_EQ(count.access, Access::constant);
  EXPECT_EQ(count.default_value->bits, 3U);
  EXPECT_EQ(findings(text.diagnostics, "sub-index-0"), (std::vector{warning_at(1, 2, "sub-index-0")}));
}

TEST(Resolve, GivesSubIndex0WithoutDefaultTheHighestSubIndex) {
  const DeviceFromText text(group("2000", "Group", "0x9", 2) + sub("2000", 0, "Count", "5") +
                            sub("2000", 4, "Four", "7"));
  EXPECT_EQ(text.entry(0x2000, 0).default_value->bits, 4U);
}

TEST(Resolve, GivesSubIndex0WithoutDefaultWhatItsObjectHoldsAfterAReset) {
  const DeviceFromText errors(group("1003", "Pre-defined error field", "0x8", 2) + sub("1003", 0, "Count", "5") +
                              sub("1003", 1, "Error", "7"));
  EXPECT_EQ(errors.entry(0x1003, 0).default_value->bits, 0U);
  const DeviceFromText mapping(group("1600", "Mapping", "0x9", 4) + sub("1600", 0, "Count", "5") +
                               sub("1600", 1, "A", "7", "DefaultValue=0x20000008\n") +
                               sub("1600", 2, "B", "7", "DefaultValue=0x20000008\n") + sub("1600", 3, "C", "7") +
                               var("2000", "V", "5"));
  EXPECT_EQ(mapping.entry(0x1600, 0).default_value->bits, 2U);
  const DeviceFromText structure(group("2000", "Group", "0x9", 3) + sub("2000", 0, "Count", "5") +
                                 sub("2000", 1, "A", "7") + var("2000subFF", "Structure", "7"));
  EXPECT_EQ(structure.entry(0x2000, 0).default_value->bits, 1U);
}

TEST(Resolve, WarnsOfSubIndicesThatLookDecimal) {
  const DeviceFromText text(group("2000", "Group", "0x9", 3) + sub("2000", 0, "Count", "5", "DefaultValue=16\n") +
                            sub("2000", 9, "Nine", "5") + sub("2000", 10, "Ten", "5"));
  EXPECT_EQ(text.device.find(0x2000)->entries.back().sub_index, 0x10);
  EXPECT_EQ(text.line_of("sub-index-base"), "[2000sub10]");
}

TEST(Resolve, CountsTheSubObjects) {
  const DeviceFromText text(group("2000", "Group", "0x9", 7) + sub("2000", 0, "Count", "5") +
                            sub("2000", 1, "One", "5"));
  EXPECT_EQ(findings(text.diagnostics, "sub-number"), (std::vector{warning_at(4, 11, "sub-number")}));
  EXPECT_EQ(text.device.find(0x2000)->entries.size(), 2U);
}

TEST(Resolve, ResolvesDescendingSectionsInAscendingOrder) {
  const DeviceFromText text(var("3000", "Later", "5") + var("2000", "Earlier", "5"));
  ASSERT_EQ(text.device.objects.size(), 2U);
  EXPECT_EQ(text.device.objects[0].index, 0x2000);
  EXPECT_EQ(text.device.objects[1].index, 0x3000);
}

// ---- limits ----

TEST(Resolve, ReadsLimitsOfNumbersOnly) {
  const DeviceFromText number(var("2000", "Value", "3", "rw", "LowLimit=-5\nHighLimit=0x7F\n"));
  EXPECT_EQ(static_cast<std::int64_t>(number.entry(0x2000).low_limit->bits), -5);
  EXPECT_EQ(number.entry(0x2000).high_limit->bits, 0x7FU);
  const DeviceFromText text(var("2000", "Value", "9", "rw", "LowLimit=a\nHighLimit=z\n"));
  EXPECT_FALSE(text.entry(0x2000).low_limit);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

// ---- compact forms (CiA 306-1, 4.6.2.6) ----

const std::string compact =
    "[2100]\nParameterName=Channel\nObjectType=0x8\nDataType=0x0006\nAccessType=rw\nDefaultValue=7\n"
    "PDOMapping=1\nCompactSubObj=3\n";

TEST(Compact, DescribesAllElementsByTheObjectsSection) {
  const DeviceFromText text(compact);
  const Object& object = *text.device.find(0x2100);
  ASSERT_EQ(object.entries.size(), 4U);
  EXPECT_EQ(object.entries[0].default_value->bits, 3U);
  EXPECT_EQ(object.entries[0].type->type, DataType::unsigned8);
  for (std::uint8_t i = 1; i <= 3; ++i) {
    const Entry& element = text.entry(0x2100, i);
    EXPECT_EQ(element.name, "Channel" + std::to_string(i));
    EXPECT_EQ(element.type->type, DataType::unsigned16);
    EXPECT_EQ(element.default_value->bits, 7U);
    EXPECT_TRUE(element.pdo_mapping);
  }
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Compact, TakesNamesAndValuesFromTheirLists) {
  const DeviceFromText text(compact +
                            "[2100Name]\nNrOfEntries=1\n2=Left\n"
                            "[2100Value]\nNrOfEntries=2\n1=0x11\n3=33\n");
  EXPECT_EQ(text.entry(0x2100, 1).default_value->bits, 0x11U);
  EXPECT_EQ(text.entry(0x2100, 2).default_value->bits, 7U);
  EXPECT_EQ(text.entry(0x2100, 3).default_value->bits, 33U);
  EXPECT_EQ(text.entry(0x2100, 1).name, "Channel1");
  EXPECT_EQ(text.entry(0x2100, 2).name, "Left");
}

TEST(Compact, LetsASectionOfItsOwnDescribeAnElement) {
  const DeviceFromText text(compact + sub("2100", 2, "Special", "0x0006", "DefaultValue=9\n"));
  EXPECT_EQ(text.entry(0x2100, 2).default_value->bits, 9U);
  EXPECT_EQ(text.entry(0x2100, 2).name, "Special");
  EXPECT_EQ(text.entry(0x2100, 3).default_value->bits, 7U);
}

TEST(Compact, HasTheCountInSubIndex0) {
  const DeviceFromText text(compact);
  EXPECT_EQ(text.entry(0x2100, 0).name, "NrOfObjects");
  EXPECT_EQ(text.entry(0x2100, 0).access, Access::ro);
  const DeviceFromText own(compact + sub("2100", 0, "Channels", "0x0005", "DefaultValue=2\n"));
  EXPECT_EQ(own.entry(0x2100, 0).name, "Channels");
  EXPECT_EQ(own.entry(0x2100, 0).default_value->bits, 2U);
}

TEST(Compact, KeepsSectionsBeyondItsElements) {
  const DeviceFromText text(compact + sub("2100", 7, "Seventh", "0x0006"));
  EXPECT_EQ(text.device.find(0x2100)->entries.size(), 5U);
  EXPECT_EQ(text.entry(0x2100, 7).name, "Seventh");
}

TEST(Compact, GivesItsListsToSubObjectsWithSectionsToo) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=1\n" + group("2100", "Group", "0x9", 2) +
                            sub("2100", 0, "Count", "5", "DefaultValue=1\n") +
                            sub("2100", 1, "One", "6", "DefaultValue=1\n") +
                            "[2100Value]\nNrOfEntries=1\n1=20\n[2100Denotation]\nNrOfEntries=1\n1=mine\n");
  EXPECT_EQ(text.entry(0x2100, 1).default_value->bits, 20U);
  EXPECT_EQ(text.entry(0x2100, 1).denotation, "mine");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Compact, TakesItsValuesInADcfBeforeTheParameterValueOfAll) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=1\n" + compact +
                            "ParameterValue=5\n[2100Value]\nNrOfEntries=1\n2=20\n");
  EXPECT_EQ(text.entry(0x2100, 1).default_value->bits, 5U);
  EXPECT_EQ(text.entry(0x2100, 2).default_value->bits, 20U);
}

TEST(Compact, WarnsOfListEntriesForNoElement) {
  const DeviceFromText text(compact + "[2100Name]\nNrOfEntries=1\n4=Fourth\n");
  EXPECT_EQ(text.line_of("compact-entry"), "4=Fourth");
}

TEST(Compact, HasAtMost254Elements) {
  const DeviceFromText text(
      "[2100]\nParameterName=Channel\nObjectType=0x8\nDataType=0x0006\nAccessType=rw\nCompactSubObj=300\n");
  EXPECT_EQ(text.device.find(0x2100)->entries.size(), 255U);
  EXPECT_EQ(findings(text.diagnostics, "compact-sub-obj"), (std::vector{warning_at(6, 15, "compact-sub-obj")}));
}

TEST(Compact, WantsANumber) {
  const DeviceFromText text(
      "[2100]\nParameterName=Channel\nObjectType=0x8\nDataType=0x0006\nAccessType=rw\nCompactSubObj=many\n");
  EXPECT_EQ(findings(text.diagnostics, "compact-sub-obj"), (std::vector{error_at(6, 15, "compact-sub-obj")}));
}

// ---- DCF (CiA 306-1, 5) ----

TEST(Dcf, TakesTheParameterValueBeforeTheDefault) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=3\n" +
                            var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=2\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 2U);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(Dcf, TakesTheDefaultWhereThereIsNoParameterValue) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=3\n" +
                            var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 1U);
}

TEST(Dcf, GivesTheNodeIdToItsFormulas) {
  const DeviceFromText text("[DeviceComissioning]\nNodeID=0x22\n" +
                            var("1014", "COB-ID EMCY", "7", "rw", "DefaultValue=$NODEID+0x80\n"));
  EXPECT_EQ(text.device.node_id, 0x22);
  EXPECT_EQ(text.entry(0x1014).default_value->bits, 0xA2U);
  EXPECT_FALSE(text.entry(0x1014).default_value->plus_node_id);
}

TEST(Dcf, GivesWayToANodeIdFromTheCommandLine) {
  const DeviceFromText text(
      "[DeviceComissioning]\nNodeID=3\n" + var("1014", "COB-ID EMCY", "7", "rw", "DefaultValue=$NODEID+0x80\n"), {},
      {"", std::uint8_t{9}});
  EXPECT_EQ(text.entry(0x1014).default_value->bits, 0x89U);
}

TEST(Dcf, HasNoNodeIdWhenItIs0Or255) {
  for (const char* number : {"0", "255", "0xFF"}) {
    const DeviceFromText text("[DeviceComissioning]\nNodeID=" + std::string{number} + "\n" + var("2000", "V", "5"));
    EXPECT_FALSE(text.device.node_id) << number;
    EXPECT_EQ(rules_of(text.diagnostics), Rules{}) << number;
  }
}

TEST(Dcf, WantsANodeIdOf1To127) {
  for (const char* number : {"128", "-1", "five"}) {
    const DeviceFromText text("[DeviceComissioning]\nNodeID=" + std::string{number} + "\n" + var("2000", "V", "5"));
    EXPECT_EQ(findings(text.diagnostics, "node-id"), (std::vector{error_at(2, 8, "node-id")})) << number;
  }
}

TEST(Eds, KeepsTheDefaultAndWarnsOfAParameterValue) {
  const DeviceFromText text(var("2000", "Value", "5", "rw", "DefaultValue=1\nParameterValue=2\n"));
  EXPECT_EQ(text.entry(0x2000).default_value->bits, 1U);
  EXPECT_EQ(findings(text.diagnostics, "parameter-value"), (std::vector{warning_at(7, 16, "parameter-value")}));
}

// ---- names ----

TEST(Names, AreUniqueInTheDevice) {
  const DeviceFromText text(var("2000", "Speed", "5") + var("2001", "speed", "5") + var("2002", "SPEED!", "5") +
                            var("2003", "speed_2001", "5"));
  std::set<std::string> names;
  for (const Object& object : text.device.objects) names.insert(object.identifier);
  EXPECT_EQ(names.size(), 4U);
  EXPECT_EQ(text.device.find(0x2000)->identifier, "speed");
  EXPECT_EQ(text.device.find(0x2001)->identifier, "speed_2001");
}

TEST(Names, OfSubObjectsAreUniqueInTheirObject) {
  const DeviceFromText text(group("2000", "Group", "0x9", 4) + sub("2000", 0, "Value", "5") +
                            sub("2000", 1, "Value", "5") + sub("2000", 2, "Value", "5") + sub("2000", 3, "", "5"));
  EXPECT_EQ(text.entry(0x2000, 0).identifier, "value");
  EXPECT_EQ(text.entry(0x2000, 1).identifier, "value_01");
  EXPECT_EQ(text.entry(0x2000, 2).identifier, "value_02");
  EXPECT_EQ(text.entry(0x2000, 3).identifier, "sub_03");
}

TEST(Names, OfSubIndex0ThatRepeatTheObjectAreTheStandardOne) {
  const DeviceFromText text(group("2000", "Group", "0x9", 2) + sub("2000", 0, "Group", "5") +
                            sub("2000", 1, "One", "5"));
  EXPECT_EQ(text.entry(0x2000, 0).identifier, "highest_sub_index_supported");
}

TEST(Names, ComeFromTheOptionsWhereTheseHaveOne) {
  Options options;
  options.names[{0x2000, 0}] = "target";
  const DeviceFromText text(var("2000", "Sollwert", "5"), options);
  EXPECT_EQ(text.device.find(0x2000)->identifier, "target");
}

TEST(Names, OfTheDeviceComeFromTheFile) {
  const auto name_of = [](const char* file) { return DeviceFromText(var("2000", "V", "5"), {}, {}, file).device.name; };
  EXPECT_EQ(name_of("drives/EZD-1136.eds"), "ezd_1136");
  EXPECT_EQ(name_of("1.eds"), "n_1");
  EXPECT_EQ(name_of("---.eds"), "device");
  EXPECT_EQ(name_of("namespace.eds"), "namespace_");
  EXPECT_EQ(DeviceFromText(var("2000", "V", "5"), {}, {"axis1", std::nullopt}).device.name, "axis1");
}

TEST(Names, OfTheDeviceHideNoFunctionOfTheCLibraryAndNoWordOfTheTables) {
  for (const char* word : {"signal", "time", "read", "index", "array", "record", "domain", "ram", "string"}) {
    EXPECT_EQ(DeviceFromText(var("2000", "V", "5"), {}, {}, std::string{word} + ".eds").device.name,
              std::string{word} + "_");
  }
}

// ---- options ----

TEST(Options, MustSpeakOfEntriesThatExist) {
  Options options;
  options.settable.push_back({0x2000, 1});
  options.string_capacity[{0x2001, 0}] = 4;
  options.names[{0x2000, 0}] = "fine";
  const DeviceFromText text(var("2000", "Value", "5"), options);
  EXPECT_EQ(findings(text.diagnostics, "options").size(), 2U);
  EXPECT_EQ(text.diagnostics.errors(), 2U);
}

TEST(Options, MustSpeakOfObjectsThatExist) {
  Options options;
  options.no_event = {{0x2000, {}}, {0x2000, 0}, {0x2000, 1}, {0x2001, {}}};
  options.static_mapping.parameters = {0x1A00};
  const DeviceFromText text(var("2000", "Value", "5"), options);
  std::vector<std::string> messages;
  for (const Diagnostic& finding : text.diagnostics.all()) {
    if (finding.rule == "options") messages.push_back(finding.message);
  }
  EXPECT_EQ(messages, (std::vector<std::string>{"option no_event names 2000h:01, which is not in the EDS",
                                                "option no_event names 2001h, which is not in the EDS",
                                                "option static_mapping names 1A00h, which is not in the EDS"}));
}

// ---- the device ----

TEST(Resolve, ReadsWhoTheDeviceIs) {
  const DeviceFromText text(
      "[DeviceInfo]\nVendorName=edsc\nVendorNumber=0x123\nProductName=Drive\nProductNumber=7\nRevisionNumber=0x10002\n"
      "[DummyUsage]\nDummy0005=1\nDummy0006=0\nDummy0007=1\n" +
      var("2000", "Value", "5"));
  EXPECT_EQ(text.device.vendor_name, "edsc");
  EXPECT_EQ(text.device.vendor_number, 0x123U);
  EXPECT_EQ(text.device.product_name, "Drive");
  EXPECT_EQ(text.device.product_number, 7U);
  EXPECT_EQ(text.device.revision_number, 0x10002U);
  EXPECT_EQ(text.device.dummies, (std::vector<std::uint16_t>{5, 7}));
}

TEST(Resolve, WarnsOfANumberOfTheDeviceThatIsNone) {
  const DeviceFromText text("[DeviceInfo]\nVendorNumber=edsc\n" + var("2000", "Value", "5"));
  EXPECT_EQ(text.device.vendor_number, 0U);
  EXPECT_EQ(findings(text.diagnostics, "device-info"), (std::vector{warning_at(2, 14, "device-info")}));
}

TEST(Resolve, ReadsTheDefaultMapping) {
  const DeviceFromText text(group("1A00", "TPDO mapping", "0x9", 3) + sub("1A00", 0, "Count", "5", "DefaultValue=1\n") +
                            sub("1A00", 1, "Entry 1", "7", "DefaultValue=0x20000008\n") +
                            sub("1A00", 2, "Entry 2", "7", "DefaultValue=0x20000008\n") + var("2000", "Value", "5"));
  ASSERT_EQ(text.device.pdos.size(), 1U);
  const Pdo& pdo = text.device.pdos.front();
  EXPECT_EQ(pdo.direction, PdoDirection::transmit);
  EXPECT_EQ(pdo.number, 1);
  ASSERT_EQ(pdo.entries.size(), 1U) << "sub-index 0 says how many entries count";
  EXPECT_EQ(pdo.entries.front().object, &text.entry(0x2000));
  EXPECT_EQ(pdo.bits(), 8U);
}

// ---- text ----

TEST(Resolve, MakesADeviceThatOwnsItsText) {
  const DeviceFromText text(
      "[FileInfo]\nDescription=a drive\n[DeviceComissioning]\nNodeName=left\n[Comments]\nLines=1\n"
      "Line1=nothing to say\n[Tools]\nItems=1\n[Tool1]\nName=tune\nCommand=tune.exe\n" +
          var("2000", "Value", "7", "rw",
              "Denotation=torque\nUnit=mNm\nFactor=0.1\nDescription=of the motor\nParamRefd=x\n"),
      {}, {}, "test.dcf");
  const Information& information = text.device.information;
  const Entry& entry = text.entry(0x2000);
  const std::vector<std::string_view> texts = {information.file.description,
                                               information.commissioning.value().node_name,
                                               information.comments.at(0),
                                               information.tools.at(0).command,
                                               entry.denotation,
                                               entry.unit,
                                               entry.factor,
                                               entry.description,
                                               entry.param_refd};
  const std::vector<std::string_view> wanted = {"a drive", "left", "nothing to say", "tune.exe", "torque",
                                                "mNm",     "0.1",  "of the motor",   "x"};
  EXPECT_EQ(texts, wanted);
  const std::string_view sheet = text.source.text();
  for (const std::string_view one : texts) {
    const bool is_view = one.data() >= sheet.data() && one.data() <= sheet.data() + sheet.size();
    EXPECT_FALSE(is_view) << one;
  }
}

}  // namespace
}  // namespace edsc
