/// Compact forms of objects (CiA 306-1, 4.6.2.6).
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

}  // namespace
}  // namespace edsc
