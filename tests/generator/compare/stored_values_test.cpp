/// Two versions of a device: which stored parameters are kept, converted and dropped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <canopen/storage/parameter_ranges.hpp>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "compare/compare_devices.hpp"
#include "compare/print_changes.hpp"
#include "compare/stored_values.hpp"
#include "format/storage_locations.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

std::string entry_text(const std::string& index, const std::string& name, const std::string& type,
                       const std::string& access, const std::string& more = "") {
  return "[" + index + "]\nParameterName=" + name + "\nObjectType=0x7\nDataType=" + type + "\nAccessType=" + access +
         "\nPDOMapping=0\n" + more;
}

/// 1010h with sub-indices 01h to `highest`.
std::string store(int highest = 1, const std::string& last_name = "Save") {
  std::string text = "[1010]\nParameterName=Store\nObjectType=0x8\nSubNumber=" + std::to_string(highest + 1) + "\n" +
                     entry_text("1010sub0", "Highest", "5", "const", "DefaultValue=" + std::to_string(highest) + "\n");
  for (int i = 1; i <= highest; ++i) {
    text += entry_text("1010sub" + std::to_string(i), i == highest ? last_name : "Save", "7", "rw", "DefaultValue=1\n");
  }
  return text;
}

using List = std::vector<std::string>;

struct ComparedStorage {
  ComparedStorage(std::string old_text, std::string new_text, Options old_options = {}, Options new_options = {})
      : before(std::move(old_text), std::move(old_options), {"device", {}}, "old.eds"),
        after(std::move(new_text), std::move(new_options), {"device", {}}, "new.eds"),
        values(compare_stored_values({before.device, before.options}, {after.device, after.options})) {}

  [[nodiscard]] List list() const {
    List list;
    for (const StoredValueChange& value : values) {
      list.push_back(
          fmt::format("{} {}{}{}", to_string(value.fate), value.entry, value.why.empty() ? "" : " ", value.why));
    }
    return list;
  }

  DeviceFromText before, after;
  std::vector<StoredValueChange> values;
};

Options storing(std::uint16_t index, std::string how) {
  Options options;
  options.storing.emplace_back(EntryAddress{index, {}}, std::move(how));
  return options;
}

TEST(StoredValues, OfTheSameVersionAreKept) {
  const std::string sheet = store() + entry_text("1017", "Time", "6", "rw") + entry_text("2000", "Gain", "6", "rw") +
                            entry_text("2001", "Status", "6", "ro") + entry_text("2002", "Output", "6", "rww");
  EXPECT_EQ(ComparedStorage(sheet, sheet).list(), (List{"kept 1017h:00", "kept 2000h:00", "kept 2002h:00"}))
      << "2002h cannot be mapped, so that it is not process data";
}

TEST(StoredValues, OfADeviceWithout1010hDoNotExist) {
  const std::string sheet = entry_text("2000", "Gain", "6", "rw");
  EXPECT_EQ(ComparedStorage(sheet, "").list(), List{});
}

TEST(StoredValues, AreConvertedOrDropped) {
  const std::string old_sheet = store() + entry_text("2000", "Gain", "6", "rw") +
                                entry_text("2001", "Offset", "6", "rw") + entry_text("2002", "Limit", "6", "rw") +
                                entry_text("2003", "Range", "6", "rw", "HighLimit=10\n") +
                                entry_text("2004", "Text", "9", "rw", "DefaultValue=longer\n");
  const std::string new_sheet = store() + entry_text("2000", "Gain", "7", "rw") +
                                entry_text("2002", "Limit", "6", "ro") +
                                entry_text("2003", "Range", "6", "rw", "HighLimit=11\n") +
                                entry_text("2004", "Text", "9", "rw", "DefaultValue=text\n");
  EXPECT_EQ(
      ComparedStorage(old_sheet, new_sheet).list(),
      (List{"converted 2000h:00 data type UNSIGNED16 becomes UNSIGNED32",
            "dropped 2001h:00 the entry does not exist any more", "dropped 2002h:00 the entry is not stored any more",
            "kept 2003h:00 a value outside none to 11 is not loaded",
            "kept 2004h:00 a text of more than 4 bytes is not loaded"}));
}

TEST(StoredValues, FollowTheOptions) {
  const std::string sheet = store() + entry_text("2000", "Gain", "6", "rw") + entry_text("2001", "Offset", "6", "ro");
  EXPECT_EQ(ComparedStorage(sheet, sheet, {}, storing(0x2000, "never")).list(),
            (List{"dropped 2000h:00 the entry is not stored any more"}));
  EXPECT_EQ(ComparedStorage(sheet, sheet, storing(0x2001, "always"), storing(0x2001, "always")).list(),
            (List{"kept 2000h:00", "kept 2001h:00"}));
}

TEST(StoredValues, ThatAreLostBreakTheStorage) {
  const std::string sheet = store() + entry_text("2000", "Gain", "6", "rw");
  const ComparedStorage compared(sheet, sheet, {}, storing(0x2000, "never"));
  Changes changes = compare_devices(compared.before.named(), compared.after.named());
  EXPECT_EQ(changes.all().size(), 0U);
  add_lost_values(compared.values, changes);
  ASSERT_EQ(changes.breaking(), 1U) << "it is not compatible";
  EXPECT_EQ(verdict_text(changes.all().front()), "breaks stored values");
  EXPECT_EQ(changes_as_json(changes)["changes"][0]["breaks"], nlohmann::ordered_json::array({"storage"}));
  changes.keep(Audience::wire);
  EXPECT_EQ(changes.all().size(), 0U);
}

TEST(StoredValues, ArePrinted) {
  const ComparedStorage compared(store() + entry_text("2000", "Gain", "6", "rw"),
                                 store() + entry_text("2000", "Gain", "7", "rw"));
  EXPECT_NE(stored_values_as_text(compared.values)
                .find("converted: 2000h:00 \"Gain\": data type UNSIGNED16 becomes UNSIGNED32 (was old.eds:"),
            std::string::npos);
  EXPECT_NE(stored_values_as_text(compared.values).find("\n0 kept, 1 converted, 0 dropped\n"), std::string::npos);
  EXPECT_EQ(stored_values_as_json(compared.values)["converted"], 1);
  EXPECT_NE(stored_values_as_markdown(compared.values).find("| 2000h:00 Gain | converted |"), std::string::npos);
}

// The comments of CANopenNode

TEST(StorageLocations, BecomeOptions) {
  const std::string text = store(6, "Save PERSIST_APP parameters") +
                           entry_text("1017", "Time", "6", "rw", ";StorageLocation=PERSIST_COMM\n") +
                           entry_text("2000", "Counter", "6", "rw", ";StorageLocation=RAM\n") +
                           entry_text("2001", "Recipe", "6", "rw", ";StorageLocation=PERSIST_APP\n") +
                           entry_text("2002", "Hours", "6", "rwr", ";StorageLocation=PERSIST_MFR\nPDOMapping=1\n") +
                           entry_text("2003", "Version", "6", "const", ";StorageLocation=ROM\n") +
                           entry_text("2004", "Gain", "6", "rw", ";StorageLocation=PERSIST_MFR\n");
  const SourceFile source{"node.eds", text};
  Diagnostics diagnostics;
  const IniFile ini = parse_ini(source, diagnostics);
  const DeviceFromText device(text);
  EXPECT_EQ(storage_options(ini, device.device, device.options).dump(),
            R"({"storage":{"entries":{"2000h:00":"never"},"sub_indices":{"06h":["2001h:00"]}}})");
}

TEST(StorageLocations, AreNullWithoutComments) {
  const std::string text = store() + entry_text("2000", "Counter", "6", "rw", "; StorageLocation is RAM\n");
  const SourceFile source{"node.eds", text};
  Diagnostics diagnostics;
  const DeviceFromText device(text);
  EXPECT_TRUE(storage_options(parse_ini(source, diagnostics), device.device, device.options).is_null());
}

// The table of 1010h

TEST(StorageTable, IsThatOfTheDocumentation) {
  std::string table = "| sub-index | parameters |\n|---|---|\n";
  for (const canopen::ParameterRange& range : canopen::parameter_ranges) {
    table += fmt::format("| {:02X}h | {} |\n", range.sub_index, range.stores);
  }
  table += fmt::format("| {:02X}h to {:02X}h | ", canopen::first_group_sub_index, canopen::last_group_sub_index);
  std::ifstream file(EDSC_SOURCE_DIR "/docs/options.md");
  const std::string document{std::istreambuf_iterator<char>{file}, {}};
  EXPECT_NE(document.find(table), std::string::npos) << table;
}

}  // namespace
}  // namespace edsc
