#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/entry_text.hpp"
#include "lint/rule_groups.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Rules = std::vector<std::string>;

struct CheckedObjects : DeviceFromText {
  explicit CheckedObjects(std::string text) : DeviceFromText(std::move(text)) {
    check_objects({device, sheet, options, diagnostics});
  }
};

TEST(ObjectRules, WarnOfEachMandatoryObjectThatIsMissing) {
  const CheckedObjects checked(var("1001", "Error register", "5", "ro"));
  const Diagnostic& finding = checked.finding("mandatory-object");
  std::vector<std::string> messages{finding.message};
  for (const Note& note : finding.notes) messages.push_back(note.message);
  EXPECT_EQ(messages,
            (std::vector<std::string>{"mandatory object 1000h is missing", "mandatory object 1018h is missing"}));
  EXPECT_EQ(checked.diagnostics.errors(), 0U);
}

/// CiA 301, 7.5.2: what belongs to SYNC, to node guarding, to EMCY, or to the stored EDS.
TEST(ObjectRules, WarnOfAnObjectWithoutTheOneThatItNeeds) {
  const std::vector<std::vector<std::string>> pairs = {{"1006", "1005"}, {"1007", "1005"}, {"1019", "1005"},
                                                       {"100C", "100D"}, {"100D", "100C"}, {"1015", "1014"},
                                                       {"1022", "1021"}};
  for (const std::vector<std::string>& pair : pairs) {
    DeviceFromText alone(var(pair[0], "Value", "7"));
    check_presence({alone.device, alone.sheet, alone.options, alone.diagnostics});
    ASSERT_EQ(findings(alone.diagnostics, "needed-object").size(), 1U) << pair[0];
    EXPECT_NE(alone.finding("needed-object").message.find("requires " + pair[1] + "h"), std::string::npos) << pair[0];
    DeviceFromText both(var(pair[0], "Value", "7") + var(pair[1], "Value", "7"));
    check_presence({both.device, both.sheet, both.options, both.diagnostics});
    EXPECT_TRUE(findings(both.diagnostics, "needed-object").empty()) << pair[0];
  }
}

TEST(ObjectLists, ThatLackObjectsAreOneFinding) {
  std::string sheet = var("1001", "Error register", "5") + var("2001", "Value 2", "5");
  for (const std::string_view index : {"2002", "2003", "2004", "2005"}) sheet += var(index, index, "5");
  const CheckedObjects checked(sheet);
  EXPECT_EQ(findings(checked.diagnostics, "object-not-listed").size(), 1U);
  EXPECT_EQ(checked.finding("object-not-listed").places, 6U);
}

TEST(ObjectRules, AreSilentOnADefaultAtItsLimits) {
  for (const char* value : {"-5", "0", "10"}) {
    const CheckedObjects checked(
        var("2000", "Value", "3", "rw", std::string{"LowLimit=-5\nHighLimit=10\nDefaultValue="} + value + "\n"));
    EXPECT_EQ(rules_of(checked.diagnostics), Rules{}) << value;
  }
}

TEST(ObjectRules, WarnOfADefaultBeyondItsLimits) {
  const CheckedObjects below(var("2000", "Value", "3", "rw", "LowLimit=-5\nHighLimit=10\nDefaultValue=-6\n"));
  EXPECT_EQ(findings(below.diagnostics, "default-outside-limits"),
            (std::vector{warning_at(8, 14, "default-outside-limits")}));
  EXPECT_EQ(below.finding("default-outside-limits").message,
            "the default value -6 of 2000h:00 \"Value\" is below its limit -5");
  const CheckedObjects above(var("2000", "Value", "3", "rw", "HighLimit=10\nDefaultValue=11\n"));
  EXPECT_NE(above.finding("default-outside-limits").message.find("is above its limit 10"), std::string::npos);
  const CheckedObjects configured(
      "[DeviceComissioning]\nNodeID=5\n" +
      var("2000", "Value", "6", "rw", "HighLimit=0x000A\nDefaultValue=1\nParameterValue=0x000B\n"));
  EXPECT_EQ(configured.finding("default-outside-limits").message,
            "the ParameterValue 0x000B of 2000h:00 \"Value\" is above its limit 0x000A");
}

/// CiA 301, 7.5.2.37: 255 if the file has no value.
TEST(ObjectRules, BlameNoFileForADefaultThatItDoesNotHave) {
  const CheckedObjects checked(group("1800", "Communication", "9", 2) +
                               var("1800sub0", "Count", "5", "const", "DefaultValue=2\n") +
                               var("1800sub2", "Type", "5", "rw", "HighLimit=240\n"));
  EXPECT_EQ(checked.entry(0x1800, 2).default_value->bits, 255U);
  EXPECT_TRUE(findings(checked.diagnostics, "default-outside-limits").empty());
}

TEST(ObjectRules, CompareLimitsAsTheTypeDoes) {
  EXPECT_EQ(rules_of(CheckedObjects(var("2000", "V", "4", "rw", "LowLimit=0xFFFFFFFE\nHighLimit=1\n")).diagnostics),
            Rules{});
  EXPECT_EQ(rules_of(CheckedObjects(var("2000", "V", "7", "rw", "LowLimit=1\nHighLimit=0xFFFFFFFE\n")).diagnostics),
            Rules{});
  EXPECT_EQ(
      rules_of(
          CheckedObjects(var("2000", "V", "8", "rw", "LowLimit=-1.5\nHighLimit=-0.5\nDefaultValue=-1\n")).diagnostics),
      Rules{});
  EXPECT_EQ(rules_of(CheckedObjects(var("2000", "V", "0x11", "rw", "LowLimit=-2\nHighLimit=1e300\n")).diagnostics),
            Rules{});
}

// Limits that cannot be checked are dropped when the device is resolved, so that every command sees the same device.

TEST(UnusableLimits, AreDroppedWhereLowIsAboveHigh) {
  const DeviceFromText read(var("2000", "Value", "3", "rw", "LowLimit=1000\nHighLimit=10\nDefaultValue=0\n"));
  EXPECT_EQ(findings(read.diagnostics, "limits-order"), (std::vector{warning_at(6, 10, "limits-order")}));
  EXPECT_EQ(read.finding("limits-order").message, "LowLimit 1000 is above HighLimit 10; neither is checked");
  EXPECT_FALSE(read.entry(0x2000).low_limit);
  EXPECT_FALSE(read.entry(0x2000).high_limit);
  EXPECT_EQ(parse_value_text(read.entry(0x2000), "500").problem, "");
  const CheckedObjects checked(std::string{read.source.text()});
  EXPECT_EQ(rules_of(checked.diagnostics), Rules{"limits-order"});
}

TEST(UnusableLimits, AreDroppedWhereATypeOfTheSheetHasThem) {
  const DeviceFromText read("[0040]\nParameterName=Percent\nObjectType=5\nDataType=6\nLowLimit=100\nHighLimit=1\n" +
                            var("2000", "Value", "0x40", "rw"));
  EXPECT_EQ(rules_of(read.diagnostics), Rules{"limits-order"});
  EXPECT_FALSE(read.entry(0x2000).low_limit);
  EXPECT_FALSE(read.entry(0x2000).high_limit);
}

TEST(UnusableLimits, AreDroppedWhereOneFollowsTheNodeId) {
  const std::string text = var("2000", "Value", "7", "rw", "LowLimit=1\nHighLimit=$NODEID+0x100\n");
  const DeviceFromText read(text);
  EXPECT_EQ(findings(read.diagnostics, "limit-formula"), (std::vector{warning_at(7, 11, "limit-formula")}));
  EXPECT_TRUE(read.entry(0x2000).low_limit);
  EXPECT_FALSE(read.entry(0x2000).high_limit);
  const DeviceFromText node_5(text, {}, {"", 5});
  EXPECT_EQ(node_5.entry(0x2000).high_limit.value().bits, 0x105U);
}

TEST(ObjectRules, DoNotCompareADefaultThatFollowsTheNodeId) {
  const CheckedObjects checked(
      var("2000", "Value", "7", "rw", "LowLimit=0x181\nHighLimit=0x1FF\nDefaultValue=$NODEID+0x180\n"));
  EXPECT_EQ(rules_of(checked.diagnostics), Rules{});
}

/// The number of elements does not change in a running device, nor do the modes that a drive supports.
TEST(EntryRules, FindADefaultValueOfAMeasuredValueOnly) {
  DeviceFromText text(group("6401", "Inputs", "0x8", 2) +
                      var("6401sub0", "Count", "5", "ro", "DefaultValue=1\nPDOMapping=1\n") +
                      var("6401sub1", "Input", "3", "ro", "DefaultValue=7\nPDOMapping=1\n") +
                      var("6502", "Supported drive modes", "7", "ro", "DefaultValue=1\nPDOMapping=1\n") +
                      var("6D02", "Supported drive modes", "7", "ro", "DefaultValue=1\nPDOMapping=1\n"));
  check_entries({text.device, text.sheet, text.options, text.diagnostics});
  EXPECT_EQ(findings(text.diagnostics, "live-default").size(), 1U);
  EXPECT_NE(text.finding("live-default").message.find("6401h:01"), std::string::npos);
}

}  // namespace
}  // namespace edsc
