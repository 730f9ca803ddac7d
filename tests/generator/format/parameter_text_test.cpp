/// Values of a device as the ParameterValues of a DCF.
#include "format/dcf/parameter_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "format/canonical_form.hpp"
#include "format/dcf/configured_values.hpp"
#include "format/dcf/make_dcf.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct SavedValue {
  unsigned data_type;
  std::string_view default_value;
  Bytes bytes;
  std::optional<std::string> text;
};

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(ParameterText, SpellsEachTypeSoThatItReadsBack) {
  const SavedValue values[] = {
      {1, "0", {1}, "1"},
      {2, "0", {0xFE}, "-2"},
      {4, "0x10", {0xFF, 0xFF, 0xFF, 0xFF}, "-1"},
      {0x10, "0", {0xFE, 0xFF, 0xFF}, "-2"},
      {5, "7", {0x1F}, "31"},
      {6, "0x7", {0x1F, 0}, "0x001F"},
      {7, "", {0x85, 1, 0, 0x80}, "0x80000185"},
      {0x1B, "0x0", {1, 2, 3, 4, 5, 6, 7, 0x88}, "0x8807060504030201"},
      {8, "0", {0, 0, 0xC0, 0x3F}, "1.5"},
      {8, "0", {0, 0, 0xC0, 0x7F}, "0x7FC00000"},
      {0x11, "0", {0x9A, 0x99, 0x99, 0x99, 0x99, 0x99, 0xB9, 0xBF}, "-0.1"},
      {9, "", bytes_of("left axis"), "left axis"},
      {9, "x", bytes_of(std::string_view{"left\0\0", 6}), "left"},
      {10, "", {0x0A, 0xFF}, "0AFF"},
      {11, "", {0x41, 0, 0xE4, 0}, "A\xC3\xA4"},
      {12, "", {1, 2, 3, 0, 4, 0}, "0x000400030201"},
  };
  for (const SavedValue& value : values) {
    const DeviceFromText sheet{"[2000]\nParameterName=A\nObjectType=7\nDataType=" + std::to_string(value.data_type) +
                               "\nAccessType=rw\nDefaultValue=" + std::string{value.default_value} + "\n"};
    const auto text = parameter_text(sheet.entry(0x2000), value.bytes);
    ASSERT_EQ(text, value.text) << value.data_type;
    const DeviceFromText dcf{"[DeviceComissioning]\nNodeID=5\n[2000]\nParameterName=A\nObjectType=7\nDataType=" +
                                 std::to_string(value.data_type) + "\nAccessType=rw\nParameterValue=" + *text + "\n",
                             {},
                             {},
                             "test.dcf"};
    Diagnostics diagnostics;
    const auto read = configured_values(dcf.sheet, dcf.device, diagnostics);
    ASSERT_EQ(read.size(), 1u) << *text;
    Bytes expected = value.bytes;
    while (value.data_type == 9 && expected.back() == 0) expected.pop_back();
    EXPECT_EQ(bytes_of(read[0].data), expected) << *text;
  }
}

TEST(ParameterText, HasNoSpellingForWhatADcfCannotHold) {
  const SavedValue values[] = {
      {6, "0", {1}, {}},
      {6, "0", {1, 2, 3, 4}, {}},
      {9, "", {}, {}},
      {9, "", bytes_of("two\nlines"), {}},
      {9, "", bytes_of(" blank"), {}},
      {9, "", {0xE4}, {}},
      {10, "", {}, {}},
      {11, "", {0x41}, {}},
      {15, "", {1}, {}},
  };
  for (const SavedValue& value : values) {
    const DeviceFromText sheet{"[2000]\nParameterName=A\nObjectType=7\nDataType=" + std::to_string(value.data_type) +
                               "\nAccessType=rw\nDefaultValue=" + std::string{value.default_value} + "\n"};
    EXPECT_EQ(parameter_text(sheet.entry(0x2000), value.bytes), std::nullopt) << value.data_type;
  }
}

TEST(MakeDcf, WritesGivenValuesAndKeepsThoseThatAreNotKnown) {
  const std::string text =
      "[FileInfo]\nFileName=a.eds\n[DeviceComissioning]\nNodeID=3\nBaudrate=125\n"
      "[2000]\nParameterName=A\nObjectType=7\nDataType=5\nAccessType=rw\nDefaultValue=1\nParameterValue=2\n"
      "[2001]\nParameterName=B\nObjectType=7\nDataType=5\nAccessType=rw\nDefaultValue=1\n"
      "[2002]\nParameterName=D\nObjectType=7\nDataType=5\nAccessType=wo\nParameterValue=8\n"
      "[2010]\nParameterName=C\nObjectType=8\nDataType=5\nAccessType=rw\nDefaultValue=4\nCompactSubObj=3\n";
  const DeviceFromText dcf{text, {}, {"", std::uint8_t{5}}, "a.dcf"};
  Diagnostics ignored;
  Document document = canonical_form(parse_ini(dcf.source, ignored), dcf.sheet, dcf.device);
  make_dcf(document, dcf.sheet, dcf.device,
           GivenValues{{{&dcf.entry(0x2001), "7"},
                        {&dcf.entry(0x2010, 1), "4"},
                        {&dcf.entry(0x2010, 2), "9"},
                        {&dcf.entry(0x2010, 3), "4"}},
                       {&dcf.entry(0x2000), &dcf.entry(0x2001)}},
           500u);
  const DeviceFromText made{to_text(document), {}, {"", std::uint8_t{5}}, "made.dcf"};
  std::string values;
  for (const ConfiguredValue& value : configured_values(made.sheet, made.device, ignored)) {
    values += entry_label(value.entry->index, value.entry->sub_index) + "=" + std::to_string(value.data[0]) + " ";
  }
  EXPECT_EQ(values, "2001h:00=7 2002h:00=8 2010h:01=4 2010h:02=9 2010h:03=4 ") << to_text(document);
  EXPECT_EQ(made.sheet.commissioning.node_id.text, "5");
  EXPECT_EQ(made.sheet.commissioning.baudrate.text, "500");
}

}  // namespace
}  // namespace edsc
