/// How a person says that a file is read: options of the options file, keys of an overlay.
#include "text/reading_choices.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

Options reading(const std::string& options) {
  const ReadOptions read(options);
  EXPECT_EQ(messages(read.diagnostics), std::vector<std::string>{});
  return read.options;
}

constexpr const char* array_with_decimal_sub_indices = R"([2022]
ParameterName=Table
ObjectType=0x8
SubNumber=4
[2022sub0]
ParameterName=Number
DataType=0x5
AccessType=const
DefaultValue=100
[2022sub9]
ParameterName=Nine
DataType=0x5
AccessType=rw
[2022sub10]
ParameterName=Ten
DataType=0x5
AccessType=rw
[2022sub100]
ParameterName=Hundred
DataType=0x5
AccessType=rw
)";

TEST(ReadingChoices, ReadDecimalSubIndices) {
  const DeviceFromText device(array_with_decimal_sub_indices, reading(R"({"sub_indices": "decimal"})"));
  EXPECT_EQ(device.entry(0x2022, 9).name, "Nine");
  EXPECT_EQ(device.entry(0x2022, 0x0A).name, "Ten");
  EXPECT_EQ(device.entry(0x2022, 100).name, "Hundred");
  EXPECT_EQ(device.device.find(0x2022, 0x10), nullptr);
  EXPECT_EQ(findings(device.diagnostics, "section-name"), std::vector<Finding>{});
}

TEST(ReadingChoices, ReadHexadecimalSubIndicesWithoutAChoice) {
  const DeviceFromText device(array_with_decimal_sub_indices);
  EXPECT_EQ(device.entry(0x2022, 0x10).name, "Ten");
  EXPECT_EQ(device.line_of("section-name"), "[2022sub100]");
}

TEST(ReadingChoices, RejectASubIndexThatIsNotDecimal) {
  const DeviceFromText device(std::string{array_with_decimal_sub_indices} + "[2022subA]\n[2022sub256]\n",
                              reading(R"({"sub_indices": "decimal"})"));
  EXPECT_EQ(device.finding("section-name").message,
            "\"2022subA\" is not a valid section name: with decimal sub-indices, a sub-index has one to three decimal "
            "digits, 255 at most");
  EXPECT_EQ(device.finding("section-name").places, 2U);
}

TEST(ReadingChoices, ExchangeTheAccessTypes) {
  const std::string text =
      "[2000]\nParameterName=A\nDataType=5\nAccessType=RWR\n[2001]\nParameterName=B\nDataType=5\n"
      "AccessType=rww ; a comment\n[2002]\nParameterName=C\nDataType=5\nAccessType=rw\n";
  const DeviceFromText device(text, reading(R"({"access_types": "swapped"})"));
  EXPECT_EQ(device.entry(0x2000).access, canopen::Access::rww);
  EXPECT_EQ(device.entry(0x2001).access, canopen::Access::rwr);
  EXPECT_EQ(device.entry(0x2002).access, canopen::Access::rw);
  EXPECT_EQ(DeviceFromText(text).entry(0x2000).access, canopen::Access::rwr);
}

TEST(ReadingChoices, ReadTheTextInItsEncoding) {
  const DeviceFromText device("[2000]\nParameterName=\xB5\xE7\xBB\xFA\nDataType=5\nAccessType=rw\n",
                              reading(R"({"encoding": "GBK"})"));
  EXPECT_EQ(device.entry(0x2000).name, "电机");
}

TEST(ReadingChoices, NameTheirValues) {
  EXPECT_EQ(messages(ReadOptions(R"({"sub_indices": "octal"})").diagnostics),
            std::vector<std::string>{"sub_indices: expected hexadecimal or decimal"});
  EXPECT_EQ(messages(ReadOptions(R"({"access_types": true})").diagnostics),
            std::vector<std::string>{"access_types: expected cia306 or swapped"});
  EXPECT_EQ(messages(ReadOptions(R"({"encoding": "EBCDIC"})").diagnostics),
            std::vector<std::string>{"encoding: expected one of " + encoding_names()});
}

TEST(ReadingChoices, AreKeysOfAnOverlayToo) {
  ReadingChoices choices;
  EXPECT_TRUE(find_reading_key("SubIndices")->set("Decimal", choices));
  EXPECT_TRUE(find_reading_key("encoding")->set("GB18030", choices));
  EXPECT_TRUE(find_reading_key("AccessTypes")->set("swapped", choices));
  EXPECT_FALSE(find_reading_key("AccessTypes")->set("both", choices));
  EXPECT_EQ(find_reading_key("Base"), nullptr);
  const Options options = reading(R"({"sub_indices": "decimal", "encoding": "GB18030", "access_types": "swapped"})");
  EXPECT_EQ(choices, options.reading);
}

}  // namespace
}  // namespace edsc
