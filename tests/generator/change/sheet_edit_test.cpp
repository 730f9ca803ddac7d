// Edits of lines: what they leave unchanged, and what follows from them.
#include "change/sheet_edit.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "change/text_edit.hpp"

namespace edsc {
namespace {

using EditStep = std::function<void(SheetEdit&, const SheetText&)>;

/// The bytes of a file after a change. The text that edsc reads then must be that of these bytes.
std::string changed(const std::string& bytes, const EditStep& change, bool allow_utf8 = false) {
  const auto file = std::make_shared<const SourceFile>("a.eds", bytes);
  const SheetText text{*file};
  SheetEdit edit{text};
  change(edit, text);
  const std::vector<TextEdit> edits = edit.finish();
  const EditedBytes edited = edited_bytes(bytes, file->encoding(), edits, allow_utf8);
  if (!edited.error.empty()) return edited.error;
  const SourceFile read{"a.eds", edited.bytes};
  EXPECT_EQ(edited_text(file, edits, file)->text(), read.text());
  return edited.bytes;
}

EditStep set(const std::string& section, const std::string& key, const std::string& value) {
  return [=](SheetEdit& edit, const SheetText& text) {
    edit.set_value(*text.find_entry(*text.find(section), key), value, {});
  };
}

EditStep add(const std::string& section, const std::string& key, const std::string& line) {
  return [=](SheetEdit& edit, const SheetText& text) { edit.add_entry(*text.find(section), key, {{line, {}}}); };
}

EditStep remove(const std::string& section) {
  return [=](SheetEdit& edit, const SheetText& text) { edit.remove_section(*text.find(section)); };
}

TEST(SheetEdit, KeepsBlanksCommentsAndLineEnds) {
  EXPECT_EQ(changed("\r\n [1000]\r\n  DataType =\t0x7 ; type\nb=2\r; c\r\n", set("1000", "datatype", "8")),
            "\r\n [1000]\r\n  DataType =\t8 ; type\nb=2\r; c\r\n");
}

TEST(SheetEdit, GivesNewLinesTheLineEndOfTheLineBefore) {
  EXPECT_EQ(changed("[1000]\r\nDataType=7\n", add("1000", "ParameterName", "ParameterName=a")),
            "[1000]\r\nParameterName=a\r\nDataType=7\n");
  EXPECT_EQ(changed("[1000]\r\nParameterName=a\n", add("1000", "DataType", "DataType=7")),
            "[1000]\r\nParameterName=a\nDataType=7\n");
}

TEST(SheetEdit, KeepsAMissingLastLineEnd) {
  EXPECT_EQ(changed("[1000]\r\nParameterName=a", add("1000", "DataType", "DataType=7")),
            "[1000]\r\nParameterName=a\r\nDataType=7");
  EXPECT_EQ(changed("[1000]\na=1", set("1000", "a", "2")), "[1000]\na=2");
  EXPECT_EQ(changed("[1000]", add("1000", "a", "a=2")), "[1000]\na=2");
}

TEST(SheetEdit, KeepsTheEncoding) {
  EXPECT_EQ(changed("\xEF\xBB\xBF[1000]\na=\xC3\xA4\nb=1\n", set("1000", "b", "\xC3\xB6")),
            "\xEF\xBB\xBF[1000]\na=\xC3\xA4\nb=\xC3\xB6\n");
  EXPECT_EQ(changed("[1000]\na=Gr\xF6\xDF"
                    "e\nb=1\n",
                    set("1000", "b", "\xC3\xBC")),
            "[1000]\na=Gr\xF6\xDF"
            "e\nb=\xFC\n");
  const std::string utf16{
      "\xFF\xFE[\0a\0]\0\n\0b\0=\0"
      "1\0",
      16};
  EXPECT_EQ(changed(utf16, set("a", "b", "\xC3\xA4")), (std::string{"\xFF\xFE[\0a\0]\0\n\0b\0=\0\xE4\0", 16}));
  const std::string big_endian{
      "\0[\0a\0]\0\r\0\n\0b\0=\0"
      "1",
      16};
  EXPECT_EQ(changed(big_endian, add("a", "c", "c=2")), (std::string{"\0[\0a\0]\0\r\0\n\0b\0=\0"
                                                                    "1\0\r\0\n\0c\0=\0"
                                                                    "2",
                                                                    26}));
}

TEST(SheetEdit, NamesACharacterThatTheEncodingDoesNotHave) {
  EXPECT_EQ(changed("[1000]\nb=1\n", set("1000", "b", "\xC2\xB5m")),
            "the encoding of the file, ASCII, does not have the character \xC2\xB5; --utf8 writes UTF-8");
  EXPECT_EQ(changed("[1000]\nb=1\n", set("1000", "b", "\xC2\xB5m"), true), "[1000]\nb=\xC2\xB5m\n");
  EXPECT_EQ(changed("[1000]\na=Gr\xF6\xDF"
                    "e\nb=1\n",
                    set("1000", "b", "\xCE\xA9")),
            "the encoding of the file, CP1252, does not have the character \xCE\xA9");
}

TEST(SheetEdit, SpellsCountsAsBefore) {
  const std::string sheet =
      "[OptionalObjects]\nSupportedObjects=0x03 ; three\n1=0x100c\n 2 = 0x1017\n3=0x1018\n[1017]\na=1\n";
  EXPECT_EQ(changed(sheet, remove("1017")), "[OptionalObjects]\nSupportedObjects=0x02 ; three\n1=0x100c\n2=0x1018\n");
  EXPECT_EQ(spelled_like(10, "0x0f"), "0x0a");
  EXPECT_EQ(spelled_like(10, "0X0F"), "0X0A");
  EXPECT_EQ(spelled_like(10, "9"), "10");
}

TEST(SheetEdit, AddsToTheEndOfAnUnsortedList) {
  const std::string sheet = "[OptionalObjects]\nSupportedObjects=2\n1=0x1018\n2=0x1005\n[1018]\na=1\n[1005]\na=1\n";
  const EditStep change = [](SheetEdit& edit, const SheetText&) {
    edit.add_section({.kind = SectionKind::object, .index = 0x1017}, {{"[1017]", {}}, {"a=2", {}}});
  };
  EXPECT_EQ(
      changed(sheet, change),
      "[OptionalObjects]\nSupportedObjects=3\n1=0x1018\n2=0x1005\n3=0x1017\n[1018]\na=1\n[1005]\na=1\n[1017]\na=2\n");
}

TEST(SheetEdit, AddsAListThatTheFileDoesNotHave) {
  const EditStep change = [](SheetEdit& edit, const SheetText&) {
    edit.add_section({.kind = SectionKind::object, .index = 0x2000}, {{"[2000]", {}}, {"a=2", {}}});
  };
  EXPECT_EQ(changed("[DeviceInfo]\na=1\n\n[MandatoryObjects]\nSupportedObjects=0\n", change),
            "[DeviceInfo]\na=1\n\n[MandatoryObjects]\nSupportedObjects=0\n\n[ManufacturerObjects]\nSupportedObjects=1\n"
            "1=0x2000\n\n[2000]\na=2\n");
}

TEST(SheetEdit, RemovesCommentsAboveASectionWithIt) {
  EXPECT_EQ(changed("[1000]\na=1\n\n; of 1001h\n[1001]\nb=1\n; end\n\n; of 1002h\n[1002]\nc=1\n", remove("1001")),
            "[1000]\na=1\n\n; of 1002h\n[1002]\nc=1\n");
  EXPECT_EQ(changed("[1000]\na=1\n\n[1001]\nb=1\n", remove("1001")), "[1000]\na=1\n");
}

}  // namespace
}  // namespace edsc
