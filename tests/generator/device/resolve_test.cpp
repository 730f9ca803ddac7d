/// A DataSheet as a Device: object types, missing keys, limits, and the device itself.
#include "device/resolve.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataType;
using Rules = std::vector<std::string>;

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
  EXPECT_NE(text.finding("sub-object-without-object").message.find("1017h:04 \"Serial number\" is ignored"),
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
  EXPECT_EQ(text.entry(0x2000).access, Access::ro);
}

/// CiA 301, 7.5.2: 1000h is ro, 1017h rw, 1024h wo.
TEST(Resolve, AssumesTheAccessTypeOfCia301) {
  const DeviceFromText text(var("1000", "Device type", "7", "unknown") + var("1017", "Heartbeat", "6", "unknown") +
                            var("1024", "OS command mode", "5", "unknown") +
                            "[1001]\nParameterName=Error register\nDataType=5\n");
  EXPECT_EQ(text.entry(0x1000).access, Access::ro);
  EXPECT_EQ(text.entry(0x1001).access, Access::ro);
  EXPECT_EQ(text.entry(0x1017).access, Access::rw);
  EXPECT_EQ(text.entry(0x1024).access, Access::wo);
}

TEST(Resolve, ReadsTheLettersOfAnAccessTypeWithAWarning) {
  const DeviceFromText text(var("2000", "Value", "5", "R") + var("2001", "Command", "5", "w") +
                            var("2002", "Setting", "5", "R/W"));
  EXPECT_EQ(text.entry(0x2000).access, Access::ro);
  EXPECT_EQ(text.entry(0x2001).access, Access::wo);
  EXPECT_EQ(text.entry(0x2002).access, Access::rw);
  EXPECT_EQ(findings(text.diagnostics, "access-type"), (std::vector{warning_at(5, 12, "access-type")}));
  EXPECT_EQ(text.finding("access-type").places, 3U);
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
  EXPECT_EQ(text.names.of(*text.device.find(0x2000)), "object_2000");
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
