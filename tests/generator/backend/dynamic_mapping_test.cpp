/// Which PDOs can be mapped over the bus, and where their mapping parameters are stored.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/memory_layout.hpp"
#include "backend/cpp/views.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

std::string sub_object(std::string_view index, int sub_index, std::string_view data_type, std::string_view access,
                       std::string_view value) {
  return fmt::format("[{}sub{:X}]\nParameterName={}\nDataType={}\nAccessType={}\nDefaultValue={}\n", index, sub_index,
                     sub_index == 0 ? "Count" : fmt::format("Entry {}", sub_index), data_type, access, value);
}

/// A communication parameter with a COB-ID.
std::string communication(std::string_view index) {
  return group(index, fmt::format("Communication {}", index), "9", 2) + sub_object(index, 0, "5", "const", "1") +
         sub_object(index, 1, "7", "rw", "$NODEID+0x180");
}

/// A mapping parameter with two entries; the first one maps 2000h.
std::string mapping(std::string_view index, std::string_view access = "rw", std::string_view count_access = "rw") {
  return group(index, fmt::format("Mapping {}", index), "9", 3) + sub_object(index, 0, "5", count_access, "1") +
         sub_object(index, 1, "7", access, "0x20000008") + sub_object(index, 2, "7", access, "0");
}

std::string tpdo(std::string_view access = "rw", std::string_view count_access = "rw") {
  return communication("1800") + mapping("1A00", access, count_access) +
         var("2000", "Input", "5", "ro", "PDOMapping=1\n");
}

Options with_static(StaticMapping mapping) {
  Options options;
  options.static_mapping = std::move(mapping);
  return options;
}

bool first_is_dynamic(const DeviceFromText& text) { return text.device.pdos.at(0).dynamic; }

MemoryLayout layout_of(DeviceFromText& text) { return lay_out(text.named(), text.options, text.diagnostics); }

/// The rows of a table in C++, each with its comment.
std::vector<std::pair<std::string, std::string>> table_of(DeviceFromText& text, const char* table) {
  std::vector<std::pair<std::string, std::string>> rows;
  const auto view = layout_view(layout_of(text));
  for (const auto& row : view[table]["rows"]) {
    rows.emplace_back(row["text"].get<std::string>(), row.value("remark", ""));
  }
  return rows;
}

/// The word of a VAR, or those of the sub-indices of a RECORD or ARRAY, as in the table.
std::string word_of(DeviceFromText& text, std::string_view label) {
  for (const auto& [word, comment] : table_of(text, "entries")) {
    if (comment.starts_with(fmt::format("  // {}", label))) return word;
  }
  return "";
}

std::vector<std::string> subs_of(DeviceFromText& text) {
  std::vector<std::string> words;
  for (const auto& [word, comment] : table_of(text, "subs")) words.push_back(word);
  return words;
}

TEST(DynamicMapping, TakesAMappingParameterOfWhichAllCanBeWritten) {
  for (const char* access : {"rw", "rww", "rwr"}) {
    EXPECT_TRUE(first_is_dynamic(DeviceFromText{tpdo(access)})) << access;
    EXPECT_TRUE(first_is_dynamic(DeviceFromText{tpdo("rw", access)})) << access;
  }
  for (const char* access : {"ro", "const", "wo"}) {
    EXPECT_FALSE(first_is_dynamic(DeviceFromText{tpdo(access)})) << access;
    EXPECT_FALSE(first_is_dynamic(DeviceFromText{tpdo("rw", access)})) << access;
  }
}

TEST(DynamicMapping, IsTurnedOffForAllPdosOrForOne) {
  EXPECT_FALSE(first_is_dynamic(DeviceFromText{tpdo(), with_static({true, {}})}));
  EXPECT_FALSE(first_is_dynamic(DeviceFromText{tpdo(), with_static({false, {0x1A00}})}));
  const DeviceFromText two{tpdo() + communication("1801") + mapping("1A01"), with_static({false, {0x1A01}})};
  EXPECT_TRUE(two.device.pdos.at(0).dynamic);
  EXPECT_FALSE(two.device.pdos.at(1).dynamic);
}

TEST(DynamicMapping, NeedsACobId) {
  EXPECT_FALSE(first_is_dynamic(DeviceFromText{mapping("1A00")}));
  const std::string without_cob_id = group("1800", "Communication", "9", 1) + sub_object("1800", 0, "5", "const", "2");
  EXPECT_FALSE(first_is_dynamic(DeviceFromText{without_cob_id + mapping("1A00")}));
}

TEST(DynamicMapping, CarriesNoString) {
  const auto dynamic = [](std::string_view data_type) {
    return first_is_dynamic(DeviceFromText{communication("1800") + mapping("1A00") +
                                           var("2000", "Input", data_type, "ro", "PDOMapping=1\nDefaultValue=R\n")});
  };
  EXPECT_TRUE(dynamic("5"));
  EXPECT_FALSE(dynamic("9"));
}

TEST(DynamicMapping, NeedsEntriesOf32BitsWithoutAGap) {
  const auto dynamic = [](const std::string& subs) {
    return first_is_dynamic(DeviceFromText{communication("1400") + group("1600", "Mapping", "9", 3) +
                                           sub_object("1600", 0, "5", "rw", "0") + subs});
  };
  EXPECT_TRUE(dynamic(sub_object("1600", 1, "7", "rw", "0") + sub_object("1600", 2, "7", "rw", "0")));
  EXPECT_FALSE(dynamic(sub_object("1600", 1, "7", "rw", "0") + sub_object("1600", 3, "7", "rw", "0")));
  EXPECT_FALSE(dynamic(sub_object("1600", 2, "7", "rw", "0") + sub_object("1600", 3, "7", "rw", "0")));
  EXPECT_TRUE(dynamic(sub_object("1600", 1, "7", "rw", "0") + sub_object("1600", 2, "6", "rw", "0")))
      << "an entry of another type is an error; it is read as UNSIGNED32";
  EXPECT_FALSE(dynamic(""));
}

TEST(DynamicMapping, HasRoomFor64Objects) {
  for (const int entries : {64, 65}) {
    std::string text =
        communication("1400") + group("1600", "Mapping", "9", entries + 1) + sub_object("1600", 0, "5", "rw", "0");
    for (int i = 1; i <= entries; ++i) text += sub_object("1600", i, "7", "rw", "0");
    EXPECT_EQ(first_is_dynamic(DeviceFromText{text}), entries == 64) << entries;
  }
}

TEST(DynamicMapping, MayBeTheApplicationsAlone) {
  Options options;
  options.settable = {{0x1A00, 0}, {0x1A00, 1}, {0x1A00, 2}};
  DeviceFromText text{tpdo("ro", "const"), options};
  EXPECT_EQ(text.diagnostics.errors(), 0U);
  EXPECT_TRUE(first_is_dynamic(text));
  EXPECT_EQ(subs_of(text),
            (std::vector<std::string>{"immediate | 1 | u8 | ro", "ram | offsetof(Communication, entry_1) | u32 | rw",
                                      "ram | offsetof(Mapping1a, count) | u8 | ro",
                                      "ram | offsetof(Mapping1a, entry_1) | u32 | ro",
                                      "ram | offsetof(Mapping1a, entry_2) | u32 | ro"}));
}

TEST(DynamicMapping, IsOfAWholeParameterOrOfNothing) {
  Options options;
  options.settable = {{0x1A00, 1}};
  const DeviceFromText text{tpdo("ro", "const"), options};
  EXPECT_FALSE(first_is_dynamic(text));
  EXPECT_EQ(text.finding("options").message,
            "option settable names 1A00h:01, but the mapping of TPDO 1 is static: all of 1A00h must be writable or "
            "settable");
}

TEST(DynamicMapping, LiesInRamTheEntriesOneBehindTheOther) {
  DeviceFromText text{tpdo()};
  const MemoryLayout layout = layout_of(text);
  const auto type = std::ranges::find(layout.record_types, "Mapping1a", &Struct::type);
  ASSERT_NE(type, layout.record_types.end());
  std::vector<std::string> members;
  for (const Member& member : type->members) members.push_back(member.type + " " + member.name);
  EXPECT_EQ(members,
            (std::vector<std::string>{"std::uint32_t entry_1", "std::uint32_t entry_2", "std::uint8_t count"}));
  EXPECT_TRUE(layout.constants.members.empty());
}

TEST(StaticMapping, LiesInFlashAndCannotBeWritten) {
  DeviceFromText text{tpdo(), with_static({true, {}})};
  EXPECT_EQ(subs_of(text),
            (std::vector<std::string>{"immediate | 1 | u8 | ro", "ram | offsetof(Communication, entry_1) | u32 | rw",
                                      "immediate | 1 | u8 | ro", "rom | offsetof(Communication, entry_1) | u32 | ro",
                                      "immediate | 0 | u32 | ro"}));
}

TEST(StaticMapping, HasAValueInTheWordsThatAllShareOnlyIfItIsThatOfAll) {
  const std::string two_objects = group("1A01", "Mapping", "9", 3) + sub_object("1A01", 0, "5", "rw", "2") +
                                  sub_object("1A01", 1, "7", "rw", "0x20000008") +
                                  sub_object("1A01", 2, "7", "rw", "0");
  DeviceFromText text{tpdo() + communication("1801") + two_objects, with_static({true, {}})};
  EXPECT_EQ(subs_of(text),
            (std::vector<std::string>{"immediate | 1 | u8 | ro", "ram | offsetof(Communication, entry_1) | u32 | rw",
                                      "rom | offsetof(Mapping1a, count) | u8 | ro",
                                      "rom | offsetof(Mapping1a, entry_1) | u32 | ro", "immediate | 0 | u32 | ro"}));
}

TEST(DynamicMapping, SharesItsWordsWithAllOfItsShape) {
  const std::string three = communication("1400") + communication("1401") + mapping("1600") + mapping("1601") + tpdo();
  DeviceFromText all_dynamic{three};
  DeviceFromText some_static{three, with_static({false, {0x1601}})};
  const std::size_t before = subs_of(all_dynamic).size();
  EXPECT_EQ(before, 2U + 3U);
  EXPECT_EQ(subs_of(some_static).size(), before + 3);
}

TEST(DynamicMapping, LeavesTheLimitsToThePdoService) {
  DeviceFromText text{communication("1800") + group("1A00", "Mapping", "9", 2) + sub_object("1A00", 0, "5", "rw", "0") +
                      "LowLimit=0\nHighLimit=8\n" + sub_object("1A00", 1, "7", "rw", "0")};
  EXPECT_TRUE(first_is_dynamic(text));
  EXPECT_TRUE(layout_of(text).limits.empty());
}

// ---- what a TPDO may map ----

std::string constants() {
  return var("2001", "Count", "5", "const", "DefaultValue=7\nPDOMapping=1\n") +
         var("2002", "Low", "3", "const", "DefaultValue=-7\nPDOMapping=1\n") +
         var("2003", "Flag", "1", "const", "DefaultValue=1\nPDOMapping=1\n") +
         var("2004", "Id", "6", "const", "DefaultValue=$NODEID+0x180\nPDOMapping=1\n") +
         var("2005", "Hidden", "5", "const", "DefaultValue=7\n");
}

TEST(DynamicMapping, GivesTheConstantsThatATpdoMayMapAnAddress) {
  DeviceFromText text{tpdo() + constants()};
  EXPECT_EQ(word_of(text, "2001h"), "rom | offsetof(Constants, count) | u8 | ro | tpdo");
  EXPECT_EQ(word_of(text, "2002h"), "rom | offsetof(Constants, low) | i16 | ro | tpdo");
  EXPECT_EQ(word_of(text, "2003h"), "rom | offsetof(Constants, flag) | boolean | ro | tpdo");
  EXPECT_EQ(word_of(text, "2004h"), "ram | offsetof(Values, application_preset.id) | u16 | ro | tpdo");
  EXPECT_EQ(word_of(text, "2005h"), "immediate | 7 | u8 | ro");
}

TEST(StaticMapping, LeavesSmallConstantsInTheTable) {
  const std::string rpdo = communication("1400") + mapping("1600");
  DeviceFromText text{rpdo + tpdo() + constants(), with_static({false, {0x1A00}})};
  EXPECT_TRUE(first_is_dynamic(text));
  EXPECT_EQ(word_of(text, "2001h"), "immediate | 7 | u8 | ro | tpdo");
  EXPECT_EQ(word_of(text, "2002h"), "immediate | 0xFFF9 | i16 | ro | tpdo");
  EXPECT_EQ(word_of(text, "2003h"), "immediate | 1 | boolean | ro | tpdo");
  EXPECT_EQ(word_of(text, "2004h"), "immediate_plus_node_id | 0x180 | u16 | ro | tpdo");
}

TEST(DynamicMapping, GivesTheCountOfAnArrayAnAddressBesideItsElements) {
  DeviceFromText text{tpdo() + "[2006]\nParameterName=Inputs\nObjectType=8\nSubNumber=3\n" +
                      sub_object("2006", 0, "5", "const", "2") + "PDOMapping=1\n" +
                      sub_object("2006", 1, "5", "ro", "0") + sub_object("2006", 2, "5", "ro", "0")};
  const auto words = subs_of(text);
  ASSERT_GE(words.size(), 2U);
  EXPECT_EQ(words.at(words.size() - 2), "rom | offsetof(Constants, inputs) | u8 | ro | tpdo");
  EXPECT_EQ(words.back(), "ram | offsetof(Values, application_cleared.inputs) | u8 | ro");
  const std::string array = word_of(text, "2006h");
  EXPECT_TRUE(array.starts_with("array | shape(") && array.ends_with(") | 0")) << array;
}

TEST(DynamicMapping, OffersNoConstantToAnRpdo) {
  DeviceFromText text{group("1010", "Store", "8", 2) + sub_object("1010", 0, "5", "const", "1") +
                      sub_object("1010", 1, "7", "rw", "1") + "PDOMapping=1\n"};
  EXPECT_EQ(subs_of(text).back(), "immediate | 1 | u32 | rw | tpdo");
}

// ---- what the device contains ----

/// The layouts of the PDOs that the runtime serves: "1 Rpdo1".
std::vector<std::string> served(DeviceFromText& text, const char* list) {
  std::vector<std::string> rows;
  const auto view = cpp_view(text.named(), text.options, text.diagnostics);
  for (const auto& row : view.at(list)) {
    rows.push_back(fmt::format("{} {}", row.at("number").get<int>(), row.at("layout").get<std::string>()));
  }
  return rows;
}

TEST(DynamicMapping, IsServedFromAnEmptyLayoutToo) {
  const std::string empty =
      group("1A01", "Mapping", "9", 2) + sub_object("1A01", 0, "5", "rw", "0") + sub_object("1A01", 1, "7", "rw", "0");
  const std::string text = tpdo() + communication("1801") + empty;
  DeviceFromText dynamic{text};
  EXPECT_EQ(served(dynamic, "tpdos"), (std::vector<std::string>{"1 Tpdo1", "2 canopen::Tpdo<>"}));
  DeviceFromText fixed{text, with_static({true, {}})};
  EXPECT_EQ(served(fixed, "tpdos"), (std::vector<std::string>{"1 Tpdo1"}));
}

TEST(DynamicMapping, IsStaticWhereItsDefaultCountsWhatMapsNothing) {
  const std::string input = var("2000", "Input", "5", "ro", "PDOMapping=1\n");
  const std::string gap = communication("1800") + group("1A00", "Mapping", "9", 3) +
                          sub_object("1A00", 0, "5", "rw", "2") + sub_object("1A00", 1, "7", "rw", "0") +
                          sub_object("1A00", 2, "7", "rw", "0x20000008");
  DeviceFromText text{gap + input};
  EXPECT_FALSE(text.device.pdos.at(0).dynamic);
  EXPECT_EQ(served(text, "tpdos"), (std::vector<std::string>{"1 Tpdo1"}));
}

TEST(DynamicMapping, IsServedFromAnEmptyLayoutWhereItsDefaultIsWrong) {
  const std::string wrong = communication("1400") + mapping("1600");  // an input in an RPDO
  DeviceFromText dynamic{wrong + var("2000", "Input", "5", "ro", "PDOMapping=1\n")};
  ASSERT_TRUE(dynamic.device.pdos.at(0).broken);
  EXPECT_EQ(served(dynamic, "rpdos"), (std::vector<std::string>{"1 canopen::Rpdo<>"}));
}

}  // namespace
}  // namespace edsc
