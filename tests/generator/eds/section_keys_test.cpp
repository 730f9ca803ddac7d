/// A row of a table of keys is all that its key needs: the reader stores it, the formatter spells it.
#include "eds/sections/section_keys.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <string>
#include <tuple>

#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "format/spelling/key_table.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

std::string lower_case(std::string_view text) {
  std::string out{text};
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Reads `KEY=7` of each row in a section, into the struct that `find` returns.
template <typename Struct, std::size_t n, typename Find>
void expect_rows_suffice(const KeyRow<Struct> (&rows)[n], std::string_view section, SectionKind kind, Find find) {
  std::set<std::uint64_t> orders;
  std::uint64_t before = 0;
  for (const KeyRow<Struct>& row : rows) {
    const std::string_view name = row.key.name;
    const KeySpelling spelling = spell_key({.kind = kind}, lower_case(name));
    if (row.key.is_numbered()) continue;
    const SourceFile source("a.eds", fmt::format("[1000]\nDataType=7\n[{}]\n{}=7\n", section, lower_case(name)));
    Diagnostics diagnostics;
    const DataSheet sheet = read_data_sheet(parse_ini(source, diagnostics), diagnostics);
    const Struct& read = find(sheet);
    EXPECT_EQ((read.*row.field).text, "7") << name;
    EXPECT_EQ(spelling.name, name);
    EXPECT_EQ(spelling.value, row.key.value) << name;
    EXPECT_EQ(spelling.hex_digits, row.key.hex_digits) << name;
    EXPECT_TRUE(orders.insert(spelling.order).second) << name;
    EXPECT_LE(before, spelling.order) << name;
    before = spelling.order;
  }
}

TEST(SectionKeys, AreReadAndSpelledByTheirRow) {
  expect_rows_suffice(file_info_keys, "FileInfo", SectionKind::file_info,
                      [](const DataSheet& sheet) -> const FileInfo& { return sheet.file_info; });
  expect_rows_suffice(device_info_keys, "DeviceInfo", SectionKind::device_info,
                      [](const DataSheet& sheet) -> const DeviceInfo& { return sheet.device_info; });
  expect_rows_suffice(commissioning_keys, "DeviceComissioning", SectionKind::device_commissioning,
                      [](const DataSheet& sheet) -> const DeviceCommissioning& { return sheet.commissioning; });
  expect_rows_suffice(
      entry_keys, "2000sub1", SectionKind::sub_object,
      [](const DataSheet& sheet) -> const EntryDescription& { return sheet.find(0x2000)->sub_objects.at(0); });
  expect_rows_suffice(object_keys, "2000", SectionKind::object,
                      [](const DataSheet& sheet) -> const ObjectDescription& { return *sheet.find(0x2000); });
  expect_rows_suffice(tool_keys, "Tool1", SectionKind::tool,
                      [](const DataSheet& sheet) -> const Tool& { return sheet.tools.at(0); });
  expect_rows_suffice(module_info_keys, "M1ModuleInfo", SectionKind::module_info,
                      [](const DataSheet& sheet) -> const ModuleDescription& { return sheet.modules.supported.at(0); });
  expect_rows_suffice(
      sub_extension_keys, "M1SubExt6000", SectionKind::module_sub_extension,
      [](const DataSheet& sheet) -> const SubExtension& { return sheet.modules.supported.at(0).sub_extensions.at(0); });
}

TEST(SectionKeys, OfPlainSectionsAreReadByTheRowOfTheSection) {
  std::apply(
      [](const auto&... sections) {
        (expect_rows_suffice(
             sections.keys, section_title(sections.kind),
             sections.kind, [&](const DataSheet& sheet) -> const auto& { return sheet.*sections.member; }),
         ...);
      },
      plain_sections);
}

TEST(SectionKeys, OfObjectsFollowTheTypeOfTheObject) {
  std::string order;
  for (const SectionKey& key : all_object_keys()) order += std::string{key.name} + " ";
  EXPECT_TRUE(order.starts_with("ParameterName ObjectType SubNumber CompactSubObj DataType AccessType ")) << order;
}

}  // namespace
}  // namespace edsc
