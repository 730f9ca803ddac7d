#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataType;
using Rules = std::vector<std::string>;

/// A bus coupler with an input module (1: two channels), a filter module (2: fixed object 2100h) and a module of four
/// bits (3).
const std::string modules =
    "[SupportedModules]\nNrOfEntries=3\n"
    "[M1ModuleInfo]\nProductName=Inputs\nProductVersion=1\nProductRevision=2\nOrderCode=DI-2\n"
    "[M1Comments]\nLines=1\nLine1=two channels\n"
    "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n"
    "[M1SubExt6000]\nParameterName=Input\nDataType=0x0005\nAccessType=ro\nPDOMapping=1\nCount=2\n"
    "[M2ModuleInfo]\nProductName=Filter\n"
    "[M2FixedObjects]\nNrOfEntries=1\n1=0x2100\n"
    "[M2Fixed2100]\nParameterName=Filters\nObjectType=0x9\nSubNumber=2\n"
    "[M2Fixed2100sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=1\n"
    "[M2Fixed2100sub1]\nParameterName=Time\nDataType=6\nAccessType=rw\nDefaultValue=10\n"
    "[M3ModuleInfo]\nProductName=Bits\n"
    "[M3SubExtends]\nNrOfEntries=1\n1=0x6200\n"
    "[M3SubExt6200]\nParameterName=Output\nDataType=0x0005\nAccessType=rww\nPDOMapping=1\nCount=0;4\n";

const std::string coupler = var("2000", "Coupler", "5");

std::string connected(const std::vector<int>& numbers) {
  std::string text = "[ConnectedModules]\nNrOfEntries=" + std::to_string(numbers.size()) + "\n";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    text += std::to_string(i + 1) + "=" + std::to_string(numbers[i]) + "\n";
  }
  return text;
}

TEST(ModularDevice, TellsWhatModulesItSupports) {
  const DeviceFromText text(modules + coupler);
  const Information& information = text.device.information;
  ASSERT_EQ(information.supported_modules.size(), 3U);
  EXPECT_EQ(information.supported_modules[0].number, 1);
  EXPECT_EQ(information.supported_modules[0].product_name, "Inputs");
  EXPECT_EQ(information.supported_modules[0].product_version, 1U);
  EXPECT_EQ(information.supported_modules[0].product_revision, 2U);
  EXPECT_EQ(information.supported_modules[0].order_code, "DI-2");
  EXPECT_EQ(information.supported_modules[0].comments, (std::vector<std::string>{"two channels"}));
  EXPECT_TRUE(information.connected_modules.empty());
  EXPECT_EQ(text.device.objects.size(), 1U) << "nothing is plugged in";
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(ModularDevice, HasTheSubIndicesOfEachModuleInTheOrderOfTheirPlaces) {
  const DeviceFromText text(modules + connected({1, 1}) + coupler);
  const Object& inputs = *text.device.find(0x6000);
  EXPECT_EQ(inputs.type, ObjectType::array);
  EXPECT_EQ(inputs.name, "Input");
  ASSERT_EQ(inputs.entries.size(), 5U);
  EXPECT_EQ(inputs.entries[0].default_value->bits, 4U);
  EXPECT_EQ(inputs.entries[4].sub_index, 4);
  EXPECT_EQ(inputs.entries[4].type->type, DataType::unsigned8);
  EXPECT_EQ(inputs.entries[4].access, Access::ro);
  EXPECT_TRUE(inputs.entries[4].pdo_mapping);
  EXPECT_EQ(text.source.line(inputs.entries[4].position.line), "[M1SubExt6000]");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(ModularDevice, ExtendsAnObjectThatItHasItself) {
  const DeviceFromText text(modules + connected({1}) + group("6000", "Inputs", "0x8", 2) +
                            var("6000sub0", "Count", "5", "ro", "DefaultValue=1\n") +
                            var("6000sub1", "Own", "5", "ro"));
  const Object& inputs = *text.device.find(0x6000);
  EXPECT_EQ(inputs.name, "Inputs");
  ASSERT_EQ(inputs.entries.size(), 4U);
  EXPECT_EQ(inputs.entries[0].default_value->bits, 3U);
  EXPECT_EQ(inputs.entries[1].name, "Own");
  EXPECT_EQ(inputs.entries[2].name, "Input");
}

TEST(ModularDevice, HasAFixedObjectOnceForAllModulesOfAKind) {
  const DeviceFromText text(modules + connected({2, 2}) + coupler);
  ASSERT_EQ(text.device.find(0x2100)->entries.size(), 2U);
  EXPECT_EQ(text.entry(0x2100, 1).default_value->bits, 10U);
  EXPECT_EQ(text.source.line(text.entry(0x2100, 1).position.line), "[M2Fixed2100sub1]");
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(ModularDevice, GathersModulesOfFewBitsInOneSubIndex) {
  const auto outputs = [](const std::vector<int>& places) {
    return DeviceFromText(modules + connected(places) + coupler).device.find(0x6200)->entries.back().sub_index;
  };
  EXPECT_EQ(outputs({3}), 1);
  EXPECT_EQ(outputs({3, 3}), 1);
  EXPECT_EQ(outputs({3, 3, 3}), 2);
  EXPECT_EQ(outputs({3, 1, 3, 3, 3, 3}), 3);
}

TEST(ModularDevice, GoesOnAtTheNextIndexWhenAnObjectIsFull) {
  const std::string small =
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=Small\n"
      "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n"
      "[M1SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nCount=3\nObjExtend=2\n";
  const DeviceFromText text(small + connected({1}) + coupler);
  EXPECT_EQ(text.device.find(0x6000)->entries.back().sub_index, 2);
  EXPECT_EQ(text.device.find(0x6001)->entries.back().sub_index, 1);
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(ModularDevice, HasNoMoreThan254SubIndicesWithoutObjExtend) {
  const std::string large =
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=Large\n"
      "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n"
      "[M1SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nCount=200\n";
  const DeviceFromText text(large + connected({1, 1}) + coupler);
  EXPECT_EQ(text.device.find(0x6000)->entries.back().sub_index, 254);
  EXPECT_EQ(findings(text.diagnostics, "module-object"), (std::vector{error_at(8, 2, "module-object")}));
}

/// A module that adds `count` sub-indices from 6000h on, `extend_after` to an object, and one that begins at 6001h.
std::string modules_that_extend(const std::string& count, const std::string& extend_after) {
  return "[SupportedModules]\nNrOfEntries=2\n[M1ModuleInfo]\nProductName=A\n[M2ModuleInfo]\nProductName=B\n"
         "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n[M2SubExtends]\nNrOfEntries=1\n1=0x6001\n"
         "[M1SubExt6000]\nParameterName=A\nDataType=5\nAccessType=ro\nCount=" +
         count + "\nObjExtend=" + extend_after +
         "\n[M2SubExt6001]\nParameterName=B\nDataType=5\nAccessType=ro\nCount=2\nObjExtend=2\n";
}

TEST(ModularDevice, FillsTheFirstObjectWithRoomForEachModule) {
  const DeviceFromText text(modules_that_extend("3", "1") + connected({1, 2, 1, 2}) + coupler);
  std::vector<std::string> names;
  for (const Object& object : text.device.objects) {
    std::string name = object.index == 0x2000 ? "" : std::to_string(object.index - 0x6000) + ":";
    for (std::size_t i = 1; i < object.entries.size(); ++i) name += object.entries[i].name;
    names.push_back(name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"", "0:A", "1:AB", "2:AB", "3:AB", "4:AB", "5:A"}));
  EXPECT_EQ(rules_of(text.diagnostics), Rules{});
}

TEST(ModularDevice, HasAtMost131072Entries) {
  const DeviceFromText text(modules_that_extend("254", "254") + connected(std::vector<int>(520, 1)) + coupler);
  EXPECT_EQ(text.finding("dictionary-size").severity, Severity::error);
  std::size_t entries = 0;
  for (const Object& object : text.device.objects) entries += object.entries.size();
  EXPECT_LE(entries, 131074U);
}

TEST(ModularDevice, ReportsThatAnObjectIsFullOnce) {
  const DeviceFromText text(modules_that_extend("200", "0") + connected({1, 1, 1, 1}) + coupler);
  EXPECT_EQ(findings(text.diagnostics, "module-object"), (std::vector{error_at(13, 2, "module-object")}));
}

TEST(ModularDevice, ReportsANumberOfNoModule) {
  const DeviceFromText text(modules + "[ConnectedModules]\nNrOfEntries=2\n1=1\n2=65537\n" + coupler);
  EXPECT_EQ(text.device.information.connected_modules, (std::vector<std::uint16_t>{1}));
  EXPECT_EQ(text.line_of("modules"), "2=65537");
}

TEST(ModularDevice, TakesItsModulesFromTheOptionsBeforeTheDcf) {
  Options options;
  options.connected_modules = {2};
  const DeviceFromText text(modules + connected({1}) + coupler, options);
  EXPECT_NE(text.device.find(0x2100), nullptr);
  EXPECT_EQ(text.device.find(0x6000), nullptr);
  EXPECT_EQ(text.device.information.connected_modules, (std::vector<std::uint16_t>{2}));
}

TEST(ModularDevice, LeavesAnEmptyPlaceEmpty) {
  const DeviceFromText text(modules + connected({0, 1}) + coupler);
  EXPECT_EQ(text.device.find(0x6000)->entries.size(), 3U);
  EXPECT_EQ(text.diagnostics.errors(), 0U);
}

TEST(ModularDevice, RejectsModulesThatItDoesNotSupport) {
  const DeviceFromText text(modules + connected({1, 4}) + coupler);
  EXPECT_EQ(text.finding("connected-module").severity, Severity::error);
  EXPECT_EQ(text.line_of("connected-module"), "2=4");
}

TEST(ModularDevice, RejectsACountThatIsNone) {
  for (const char* count : {"", "many", "2;4", "0;", "300", "0;65"}) {
    const DeviceFromText text(
        "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=X\n[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n"
        "[M1SubExt6000]\nParameterName=Input\nDataType=5\nAccessType=ro\nCount=" +
        std::string{count} + "\n" + connected({1}) + coupler);
    EXPECT_EQ(findings(text.diagnostics, "module-count"), (std::vector{error_at(12, 7, "module-count")})) << count;
  }
}

TEST(ModularDevice, WarnsOfListsThatDifferFromTheSections) {
  const DeviceFromText listed(
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=X\n[M1FixedObjects]\nNrOfEntries=1\n1=0x6000\n" +
      coupler);
  EXPECT_EQ(listed.line_of("object-without-section"), "1=0x6000");
  const DeviceFromText described(
      "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=X\n[M1Fixed6000]\nDataType=5\n"
      "[OptionalObjects]\nSupportedObjects=1\n1=0x2000\n" +
      coupler);
  EXPECT_EQ(described.line_of("object-not-listed"), "[M1Fixed6000]");
}

TEST(ModularDevice, WarnsOfAWrongNumberOfModules) {
  EXPECT_EQ(
      findings(
          DeviceFromText("[SupportedModules]\nNrOfEntries=2\n[M1ModuleInfo]\nProductName=X\n" + coupler).diagnostics,
          "modules"),
      (std::vector{warning_at(2, 13, "modules")}));
  EXPECT_EQ(findings(DeviceFromText("[M1ModuleInfo]\nProductName=X\n" + coupler).diagnostics, "modules"),
            (std::vector{warning_at(1, 2, "modules")}));
  EXPECT_EQ(findings(DeviceFromText("[SupportedModules]\nNrOfEntries=1\n[M1Comments]\nLines=0\n" + coupler).diagnostics,
                     "modules"),
            (std::vector{warning_at(3, 2, "modules")}));
}

TEST(ModularDevice, KeepsItsOwnObjectBeforeThatOfAModule) {
  const DeviceFromText text(modules + connected({2}) + var("2100", "Own", "5"));
  EXPECT_EQ(text.device.find(0x2100)->name, "Own");
  EXPECT_EQ(text.line_of("module-object"), "[M2Fixed2100]");
}

}  // namespace
}  // namespace edsc
