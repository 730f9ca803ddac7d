/// Identifiers and C++ names of the device and its objects, and options that name entries.
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

// ---- names ----

TEST(Names, AreUniqueInTheDevice) {
  const DeviceFromText text(var("2000", "Speed", "5") + var("2001", "speed", "5") + var("2002", "SPEED!", "5") +
                            var("2003", "speed_2001", "5"));
  std::set<std::string> names;
  for (const Object& each : text.device.objects) names.insert(text.names.of(each));
  EXPECT_EQ(names.size(), 4U);
  EXPECT_EQ(text.names.of(*text.device.find(0x2000)), "speed");
  EXPECT_EQ(text.names.of(*text.device.find(0x2001)), "speed_2001");
}

TEST(Names, HaveAnUnderscoreInCppOnlyWhereCppReservesThem) {
  Options options;
  options.names[{0x2004, 0}] = "float_";
  const DeviceFromText text(var("2000", "Switch", "5") + var("2001", "SWITCH", "5") + var("2002", "Speed", "5") +
                                group("2003", "Class", "0x9", 2) + sub("2003", 0, "Value", "5") +
                                sub("2003", 1, "Type", "5") + var("2004", "Set value", "5"),
                            options);
  const Identifiers& identifiers = text.names.identifiers();
  const auto expect = [&](std::uint16_t index, const char* identifier, const char* cpp_name) {
    EXPECT_EQ(identifiers.of(*text.device.find(index)), identifier);
    EXPECT_EQ(text.names.of(*text.device.find(index)), cpp_name);
  };
  expect(0x2000, "switch", "switch_");
  expect(0x2001, "switch_2001", "switch_2001");
  expect(0x2002, "speed", "speed");
  expect(0x2003, "class", "class_");
  expect(0x2004, "float", "float_");
  EXPECT_EQ(identifiers.of(text.entry(0x2003, 1)), "type");
  EXPECT_EQ(text.names.of(text.entry(0x2003, 1)), "type_");
  EXPECT_EQ(text.names.type_of(*text.device.find(0x2003), text.entry(0x2003, 1)).text(), "od::class_::type_");
}

TEST(Names, OfSubObjectsAreUniqueInTheirObject) {
  const DeviceFromText text(group("2000", "Group", "0x9", 4) + sub("2000", 0, "Value", "5") +
                            sub("2000", 1, "Value", "5") + sub("2000", 2, "Value", "5") + sub("2000", 3, "", "5"));
  EXPECT_EQ(text.names.of(text.entry(0x2000, 0)), "value");
  EXPECT_EQ(text.names.of(text.entry(0x2000, 1)), "value_01");
  EXPECT_EQ(text.names.of(text.entry(0x2000, 2)), "value_02");
  EXPECT_EQ(text.names.of(text.entry(0x2000, 3)), "sub_03");
}

TEST(Names, OfSubIndex0ThatRepeatTheObjectAreTheStandardOne) {
  const DeviceFromText text(group("2000", "Group", "0x9", 2) + sub("2000", 0, "Group", "5") +
                            sub("2000", 1, "One", "5"));
  EXPECT_EQ(text.names.of(text.entry(0x2000, 0)), "highest_sub_index_supported");
}

TEST(Names, ComeFromTheOptionsWhereTheseHaveOne) {
  Options options;
  options.names[{0x2000, 0}] = "target";
  const DeviceFromText text(var("2000", "Sollwert", "5"), options);
  EXPECT_EQ(text.names.of(*text.device.find(0x2000)), "target");
}

TEST(Names, OfTheDeviceComeFromTheFile) {
  const auto name_of = [](const char* file) {
    return DeviceFromText(var("2000", "V", "5"), {}, {}, file).names.space();
  };
  EXPECT_EQ(name_of("drives/EZD-1136.eds"), "ezd_1136");
  EXPECT_EQ(name_of(R"(C:\Drives\EZD-1136.eds)"), "ezd_1136");
  EXPECT_EQ(name_of("C:EZD-1136.eds"), "ezd_1136");
  EXPECT_EQ(name_of("1.eds"), "n_1");
  EXPECT_EQ(name_of("---.eds"), "device");
  EXPECT_EQ(name_of("namespace.eds"), "namespace_");
  EXPECT_EQ(DeviceFromText(var("2000", "V", "5"), {}, {}, "signal.eds").names.identifiers().device(), "signal");
  EXPECT_EQ(DeviceFromText(var("2000", "V", "5"), {}, {"axis1", std::nullopt}).names.space(), "axis1");
}

TEST(Names, OfTheDeviceHideNoFunctionOfTheCLibraryAndNoWordOfTheTables) {
  for (const char* word : {"signal", "time", "read", "index", "array", "record", "domain", "ram", "string"}) {
    EXPECT_EQ(DeviceFromText(var("2000", "V", "5"), {}, {}, std::string{word} + ".eds").names.space(),
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
    if (finding.rule.text() == "options") messages.push_back(finding.message);
  }
  EXPECT_EQ(messages, (std::vector<std::string>{"option pdo.no_event names 2000h:01, which is not in the EDS",
                                                "option pdo.no_event names 2001h, which is not in the EDS",
                                                "option pdo.static_mapping names 1A00h, which is not in the EDS"}));
}

}  // namespace
}  // namespace edsc
