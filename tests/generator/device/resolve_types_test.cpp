/// Data types of objects: basic types, DEFTYPEs, DEFSTRUCTs and unknown types.
#include "device/resolve.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::DataType;
using Rules = std::vector<std::string>;

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

/// Only the names of CiA 301: `word` and `int` are other types in other tools.
TEST(Resolve, WantsANumberForDataType) {
  const DeviceFromText named(var("2000", "Value", "Unsigned16"));
  EXPECT_EQ(named.entry(0x2000).type->type, DataType::unsigned16);
  EXPECT_EQ(findings(named.diagnostics, "data-type"), (std::vector{warning_at(4, 10, "data-type")}));
  const DeviceFromText word(var("2000", "Value", "word"));
  EXPECT_EQ(findings(word.diagnostics, "data-type"), (std::vector{error_at(4, 10, "data-type")}));
}

/// CiA 301, 7.5.2. Entries that a service uses need the type of the standard; others may have their own.
TEST(Resolve, TakesTheTypeThatAServiceNeeds) {
  struct Row {
    std::string_view index, type;
    DataType needed;
  };
  constexpr Row rows[] = {
      {"1005", "0x1B", DataType::unsigned32}, {"1006", "0x1B", DataType::unsigned32},
      {"100D", "0x1B", DataType::unsigned8},  {"1014", "0x1B", DataType::unsigned32},
      {"1015", "0x1B", DataType::unsigned16}, {"1017", "0x1B", DataType::unsigned16},
      {"1017", "0x8", DataType::unsigned16},  {"1017", "0x9", DataType::unsigned16},
      {"1019", "0x7", DataType::unsigned8},
  };
  for (const Row& row : rows) {
    const DeviceFromText text(var(row.index, "Value", row.type));
    EXPECT_EQ(text.device.objects.front().entries.front().type->type, row.needed) << row.index;
    EXPECT_EQ(findings(text.diagnostics, "standard-data-type"), (std::vector{error_at(4, 10, "standard-data-type")}));
  }
  const DeviceFromText version(var("100A", "Software version", "0x6", "ro"));
  EXPECT_EQ(version.entry(0x100A).type->type, DataType::unsigned16);
  for (const auto& [code, errors] : {std::pair{"0x6", 0U}, std::pair{"0x1B", 1U}}) {
    const DeviceFromText behavior(group("1029", "Error behavior", "0x8", 2) + var("1029sub0", "Count", "5", "ro") +
                                  var("1029sub1", "Communication error", code));
    EXPECT_EQ(behavior.diagnostics.errors(), errors) << code;
  }
  const DeviceFromText pdo(group("1800", "TPDO", "0x9", 3) + var("1800sub0", "Count", "5", "ro") +
                           var("1800sub1", "COB-ID", "0x6") + var("1800sub4", "Reserved", "0x7"));
  EXPECT_EQ(pdo.entry(0x1800, 1).type->type, DataType::unsigned32);
  EXPECT_EQ(pdo.entry(0x1800, 4).type->type, DataType::unsigned32) << "as the EDS states it";
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

}  // namespace
}  // namespace edsc
