/// The maximum size of a generated dictionary, and the object that is reported if a device exceeds it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/cpp/memory_layout.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

/// `count` ARRAYs of 254 elements of 8 bytes, starting at 2000h: 2032 bytes each.
std::string arrays(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += fmt::format("[{:04X}]\nParameterName=A{}\nObjectType=8\nDataType=0x1B\nAccessType=rw\nCompactSubObj=254\n",
                        0x2000 + i, i);
  }
  return text;
}

std::string values(int count, std::string_view data_type) {
  std::string text;
  for (int i = 0; i < count; ++i) text += var(fmt::format("{:04X}", 0x3000 + i), fmt::format("V{}", i), data_type);
  return text;
}

/// The findings about the size.
std::vector<std::string> size_findings(DeviceFromText& device, const Options& options = {}) {
  static_cast<void>(lay_out(device.named(), options, device.diagnostics));
  std::vector<std::string> messages;
  for (const Diagnostic& finding : device.diagnostics.all()) {
    if (finding.rule.text() == "dictionary-size") messages.push_back(finding.message);
  }
  return messages;
}

TEST(DictionarySize, Takes64KiBOfValues) {
  DeviceFromText full{arrays(32) + values(64, "0x1B")};
  EXPECT_TRUE(size_findings(full).empty());
}

TEST(DictionarySize, NamesTheValueThatHasNoRoom) {
  DeviceFromText over{arrays(32) + values(64, "0x1B") + var("4000", "Over", "0x05")};
  EXPECT_EQ(
      size_findings(over),
      (std::vector<std::string>{
          "4000h \"Over\" does not fit: a dictionary has 64 KiB for values in RAM, and 65536 bytes lie before it"}));
  EXPECT_EQ(over.line_of("dictionary-size"), "[4000]");
}

TEST(DictionarySize, CountsTheLengthAndTheTerminatorOfStrings) {
  Options options;
  options.string_capacity = {{{0x4000, 0}, 62}};  // plus 2 bytes for the length
  const std::string text = arrays(32) + values(56, "0x1B") + var("4000", "Text", "0x09");
  DeviceFromText fits{text, options};
  EXPECT_TRUE(size_findings(fits, options).empty());
  options.zero_terminated_strings = true;
  DeviceFromText over{text, options};
  EXPECT_EQ(size_findings(over, options).size(), 1u);
}

TEST(DictionarySize, NamesTheRecordWhoseRowsHaveNoRoom) {
  std::string text;
  for (int i = 0; i < 260; ++i) {
    text += group(fmt::format("{:04X}", 0x2000 + i), fmt::format("R{}", i), "9", 255);
    for (int sub = 0; sub < 255; ++sub) {
      text += fmt::format("[{:04X}sub{:X}]\nParameterName=S{}\nDataType=6\nAccessType=const\nDefaultValue={}\n",
                          0x2000 + i, sub, sub, i + sub);
    }
  }
  DeviceFromText over{text};
  const auto findings = size_findings(over);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings.front(), "2101h \"R257\" does not fit: a dictionary can have 65535 rows for distinct sub-indices");
}

TEST(DictionarySize, NamesTheRecordWhoseStructureHasNoRoom) {
  std::string text;
  for (int i = 0; i <= 0x4000; ++i) {  // a constant is part of the structure
    const std::string index = fmt::format("{:04X}", 0x2000 + i);
    text += group(index, fmt::format("R{}", i), "9", 2);
    text += fmt::format("[{}sub0]\nParameterName=S0\nDataType=5\nAccessType=const\nDefaultValue=1\n", index);
    text += fmt::format("[{}sub1]\nParameterName=S1\nDataType=6\nAccessType=const\nDefaultValue={}\n", index, i);
  }
  DeviceFromText over{text};
  EXPECT_EQ(size_findings(over),
            (std::vector<std::string>{"6000h \"R16384\" does not fit: a dictionary can have 16384 different structures "
                                      "of ARRAYs and RECORDs"}));
}

TEST(DictionarySize, LeavesOutWhatFollowsTooManyEntriesInCompactForm) {
  DeviceFromText over{arrays(600)};
  EXPECT_EQ(over.line_of("dictionary-size"), "[2202]");
  EXPECT_EQ(over.device.objects.size(), 515u);
}

}  // namespace
}  // namespace edsc
