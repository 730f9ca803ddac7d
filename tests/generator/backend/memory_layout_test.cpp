/// Which ARRAYs use one word for all elements.
#include "backend/cpp/memory_layout.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "backend/cpp/views.hpp"
#include "device/uniform_array.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

struct Element {
  std::string_view data_type = "0x7";
  std::string_view access = "rw";
  std::string_view keys = "";
};

/// An ARRAY 2000h of sub-index 0 and these elements.
std::string array_of(const std::vector<Element>& elements, std::string_view count_keys = "") {
  std::string text =
      group("2000", "Values", "0x8", static_cast<int>(elements.size()) + 1) +
      var("2000sub0", "Count", "0x5", "const", fmt::format("DefaultValue={}\n{}", elements.size(), count_keys));
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element& element = elements[i];
    text += var(fmt::format("2000sub{:X}", i + 1), fmt::format("Value {}", i + 1), element.data_type, element.access,
                element.keys);
  }
  return text;
}

bool is_uniform(const std::vector<Element>& elements) {
  const DeviceFromText text(array_of(elements));
  return describes_uniform_array(*text.device.find(0x2000));
}

TEST(UniformArray, HasElementsOfOneKind) {
  EXPECT_TRUE(is_uniform({{}, {}}));
  EXPECT_TRUE(is_uniform({{}}));
  EXPECT_TRUE(is_uniform({{"0x7", "rw", "LowLimit=1\nHighLimit=5\n"}, {"0x7", "rw", "LowLimit=1\nHighLimit=5\n"}}));
}

TEST(UniformArray, HasNoElementOfAnotherTypeAccessOrMapping) {
  EXPECT_FALSE(is_uniform({{}, {"0x6"}}));
  EXPECT_FALSE(is_uniform({{}, {"0x7", "ro"}}));
  EXPECT_FALSE(is_uniform({{}, {"0x7", "rw", "PDOMapping=1\n"}}));
  EXPECT_FALSE(is_uniform({{"0x9"}, {"0x9"}})) << "strings have capacities of their own";
}

TEST(UniformArray, HasTheSameLimitsForAllElements) {
  EXPECT_FALSE(is_uniform({{"0x7", "rw", "LowLimit=1\n"}, {"0x7", "rw", "LowLimit=2\n"}}));
  EXPECT_FALSE(is_uniform({{"0x7", "rw", "HighLimit=10\n"}, {"0x7", "rw", "HighLimit=9\n"}}));
  EXPECT_FALSE(is_uniform({{"0x7", "rw", "HighLimit=10\n"}, {}}));
  EXPECT_FALSE(is_uniform({{}, {"0x7", "rw", "LowLimit=1\n"}}));
  EXPECT_FALSE(is_uniform({{}, {}, {"0x7", "rw", "LowLimit=1\n"}}));
}

std::vector<std::string> limits_of(DeviceFromText& text) {
  std::vector<std::string> limits;
  const auto view = layout_view(lay_out(text.named(), text.options, text.diagnostics));
  for (const auto& row : view["limits"]["rows"]) limits.push_back(row["text"].get<std::string>());
  return limits;
}

TEST(UniformArray, HasTheLimitsOfItsElementsOnce) {
  DeviceFromText text(
      array_of({{"0x7", "rw", "LowLimit=1\nHighLimit=10\n"}, {"0x7", "rw", "LowLimit=1\nHighLimit=10\n"}}));
  const std::vector<std::string> limits = limits_of(text);
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_NE(limits[0].find("0x2000, 0x01"), std::string::npos) << limits[0];
}

TEST(UniformArray, KeepsLimitsOfEachElementWhereTheyDiffer) {
  DeviceFromText text(
      array_of({{"0x7", "rw", "LowLimit=1\nHighLimit=10\n"}, {"0x7", "rw", "LowLimit=1\nHighLimit=9\n"}}));
  const std::vector<std::string> limits = limits_of(text);
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_NE(limits[0].find("0x2000, 0x01"), std::string::npos) << limits[0];
  EXPECT_NE(limits[1].find("0x2000, 0x02"), std::string::npos) << limits[1];
}

TEST(Limits, OfTheWholeTypeHaveNoRow) {
  struct Row {
    std::string_view data_type, limits;
    std::size_t rows;
  };
  constexpr Row rows[] = {
      {"0x5", "LowLimit=0\nHighLimit=255\n", 0},
      {"0x5", "LowLimit=0\nHighLimit=254\n", 1},
      {"0x5", "HighLimit=0xFF\n", 0},
      {"0x3", "LowLimit=-32768\nHighLimit=32767\n", 0},
      {"0x3", "LowLimit=-32767\nHighLimit=32767\n", 1},
      {"0x4", "LowLimit=-2147483648\nHighLimit=2147483647\n", 0},
      {"0x7", "LowLimit=0\nHighLimit=0xFFFFFFFF\n", 0},
      {"0x7", "LowLimit=1\nHighLimit=0xFFFFFFFF\n", 1},
  };
  for (const auto& [data_type, limits, count] : rows) {
    DeviceFromText text(array_of({{data_type, "rw", limits}}));
    EXPECT_EQ(limits_of(text).size(), count) << data_type << ' ' << limits;
  }
}

/// A TPDO with dynamic mapping needs an address of everything that it can map, including constants.
constexpr std::string_view dynamic_tpdo =
    "[1800]\nParameterName=Communication\nObjectType=0x9\nSubNumber=2\n"
    "[1800sub0]\nParameterName=Count\nDataType=0x5\nAccessType=const\nDefaultValue=1\n"
    "[1800sub1]\nParameterName=COB-ID\nDataType=0x7\nAccessType=rw\nDefaultValue=$NODEID+0x180\n"
    "[1A00]\nParameterName=Mapping\nObjectType=0x9\nSubNumber=2\n"
    "[1A00sub0]\nParameterName=Count\nDataType=0x5\nAccessType=rw\nDefaultValue=0\n"
    "[1A00sub1]\nParameterName=Entry\nDataType=0x7\nAccessType=rw\nDefaultValue=0\n";

/// `array` or `record`: the kind of 2000h in the table of objects.
std::string kind_of_2000h(const std::string& file) {
  DeviceFromText text(file);
  for (const EntryRow& row : lay_out(text.named(), text.options, text.diagnostics).entries) {
    if (row.object->index == 0x2000) return row.is_array ? "array" : "record";
  }
  return "";
}

TEST(UniformArray, IsARecordWhenItsCountAndElementsAreInFlash) {
  const std::vector<Element> constants(2, {"0x7", "const", "DefaultValue=0x12345\nPDOMapping=1\n"});
  EXPECT_EQ(kind_of_2000h(std::string{dynamic_tpdo} + array_of(constants, "PDOMapping=1\n")), "record");
  EXPECT_EQ(kind_of_2000h(std::string{dynamic_tpdo} + array_of(constants)), "array");
  EXPECT_EQ(kind_of_2000h(array_of(constants, "PDOMapping=1\n")), "array");
  EXPECT_EQ(kind_of_2000h(array_of({{}, {}})), "array");
}

}  // namespace
}  // namespace edsc
