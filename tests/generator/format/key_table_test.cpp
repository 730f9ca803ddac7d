/// All keys of CiA 306-1, section by section.
#include "format/spelling/key_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {
namespace {

struct KnownKey {
  std::string_view name;
  ValueKind value = ValueKind::text;
  int hex_digits = 1;
};

struct KnownSection {
  SectionKind kind;
  std::vector<KnownKey> keys;  ///< in the order of CiA 306-1
};

constexpr ValueKind number_kind = ValueKind::number, typed_kind = ValueKind::typed, count_kind = ValueKind::count,
                    parts_kind = ValueKind::parts;

/// The spelling of a key in a section of this kind.
KeySpelling spelling_in(SectionKind kind, std::string_view key) { return spell_key({.kind = kind}, key); }

const KnownSection sections_of_cia306[] = {
    {SectionKind::file_info,
     {{"FileName"},
      {"FileVersion"},
      {"FileRevision"},
      {"EDSVersion"},
      {"Description"},
      {"CreationTime"},
      {"CreationDate"},
      {"CreatedBy"},
      {"ModificationTime"},
      {"ModificationDate"},
      {"ModifiedBy"},
      {"LastEDS"}}},
    {SectionKind::device_info,  // the keys from LSS_Master on are defined in other documents
     {{"VendorName"},
      {"VendorNumber", number_kind, 8},
      {"ProductName"},
      {"ProductNumber", number_kind, 8},
      {"RevisionNumber", number_kind, 8},
      {"OrderCode"},
      {"BaudRate_10", number_kind},
      {"BaudRate_20", number_kind},
      {"BaudRate_50", number_kind},
      {"BaudRate_125", number_kind},
      {"BaudRate_250", number_kind},
      {"BaudRate_500", number_kind},
      {"BaudRate_800", number_kind},
      {"BaudRate_1000", number_kind},
      {"SimpleBootUpMaster", number_kind},
      {"SimpleBootUpSlave", number_kind},
      {"Granularity", number_kind},
      {"DynamicChannelsSupported", number_kind},
      {"CompactPDO", number_kind},
      {"GroupMessaging", number_kind},
      {"NrOfRXPDO", number_kind},
      {"NrOfTXPDO", number_kind},
      {"LSS_Supported", number_kind},
      {"LSS_Master"},
      {"NG_Slave"},
      {"NG_Master"},
      {"NrOfNG_MonitoredNodes"},
      {"CANopenSafetySupported"}}},
    {SectionKind::dummy_usage,
     {{"Dummy0001", number_kind}, {"Dummy0002", number_kind}, {"Dummy0007", number_kind}, {"Dummy001B", number_kind}}},
    {SectionKind::comments, {{"Lines", count_kind}, {"Line1"}, {"Line2"}, {"Line10"}}},
    {SectionKind::device_commissioning,
     {{"NodeID", number_kind, 2},
      {"NodeName"},
      {"NodeRefd"},
      {"Baudrate", number_kind},
      {"NetNumber", number_kind},
      {"NetworkName"},
      {"NetRefd"},
      {"CANopenManager", number_kind},
      {"LSS_SerialNumber", number_kind, 8}}},
    {SectionKind::mandatory_objects, {{"SupportedObjects", count_kind}, {"1", number_kind, 4}, {"12", number_kind, 4}}},
    {SectionKind::optional_objects, {{"SupportedObjects", count_kind}, {"1", number_kind, 4}, {"12", number_kind, 4}}},
    {SectionKind::manufacturer_objects,
     {{"SupportedObjects", count_kind}, {"1", number_kind, 4}, {"12", number_kind, 4}}},
    {SectionKind::object,  // Unit, Factor and Description are not in CiA 306, but common
     {{"ParameterName"},
      {"ObjectType", number_kind},
      {"SubNumber", number_kind},
      {"CompactSubObj", number_kind},
      {"DataType", number_kind, 4},
      {"AccessType", ValueKind::access},
      {"LowLimit", typed_kind},
      {"HighLimit", typed_kind},
      {"DefaultValue", typed_kind},
      {"ParameterValue", typed_kind},
      {"PDOMapping", number_kind},
      {"ObjFlags", number_kind},
      {"Denotation"},
      {"UploadFile"},
      {"DownloadFile"},
      {"ParamRefd"},
      {"Unit"},
      {"Factor"},
      {"Description"}}},
    {SectionKind::sub_object,
     {{"ParameterName"},
      {"ObjectType", number_kind},
      {"DataType", number_kind, 4},
      {"AccessType", ValueKind::access},
      {"LowLimit", typed_kind},
      {"HighLimit", typed_kind},
      {"DefaultValue", typed_kind},
      {"ParameterValue", typed_kind},
      {"PDOMapping", number_kind},
      {"ObjFlags", number_kind},
      {"Denotation"},
      {"UploadFile"},
      {"DownloadFile"},
      {"ParamRefd"},
      {"Unit"},
      {"Factor"},
      {"Description"}}},
    {SectionKind::compact_names, {{"NrOfEntries", count_kind}, {"1"}, {"254"}}},
    {SectionKind::compact_values, {{"NrOfEntries", count_kind}, {"1", typed_kind}, {"254", typed_kind}}},
    {SectionKind::compact_denotations, {{"NrOfEntries", count_kind}, {"1"}, {"254"}}},
    {SectionKind::object_links, {{"ObjectLinks", count_kind}, {"1", number_kind, 4}}},
    {SectionKind::dynamic_channels,  // the keys of a segment are together
     {{"NrOfSeg", parts_kind},
      {"Type1", number_kind, 4},
      {"Dir1"},
      {"Range1", ValueKind::index_range, 4},
      {"PPOffset1", number_kind},
      {"Type2", number_kind, 4},
      {"PPOffset12", number_kind}}},
    {SectionKind::tools, {{"Items", parts_kind}}},
    {SectionKind::tool, {{"Name"}, {"Command"}}},
    {SectionKind::supported_modules, {{"NrOfEntries", parts_kind}}},
    {SectionKind::module_info,
     {{"ProductName"}, {"ProductVersion", number_kind}, {"ProductRevision", number_kind}, {"OrderCode"}}},
    {SectionKind::module_fixed_objects, {{"NrOfEntries", count_kind}, {"1", number_kind, 4}, {"12", number_kind, 4}}},
    {SectionKind::module_sub_extends, {{"NrOfEntries", count_kind}, {"1", number_kind, 4}, {"12", number_kind, 4}}},
    {SectionKind::module_sub_extension,
     {{"ParameterName"},
      {"ObjectType", number_kind},
      {"DataType", number_kind, 4},
      {"AccessType", ValueKind::access},
      {"LowLimit", typed_kind},
      {"HighLimit", typed_kind},
      {"DefaultValue", typed_kind},
      {"PDOMapping", number_kind},
      {"Count", ValueKind::module_count},
      {"ObjExtend", number_kind}}},
    {SectionKind::module_comments, {{"Lines", count_kind}, {"Line1"}, {"Line2"}}},
    {SectionKind::connected_modules, {{"NrOfEntries", count_kind}, {"1", number_kind}}},
};

std::string in_lower_case(std::string_view text) {
  std::string lower{text};
  std::ranges::transform(lower, lower.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return lower;
}

TEST(KeyTable, HasEachKeyOfCia306InItsPlaceAndWithItsKindOfValue) {
  for (const KnownSection& section : sections_of_cia306) {
    std::uint64_t before = 0;
    for (const KnownKey& key : section.keys) {
      const KeySpelling spelled = spelling_in(section.kind, in_lower_case(key.name));
      EXPECT_TRUE(spelled.is_known) << key.name;
      EXPECT_EQ(spelled.name, key.name);
      EXPECT_EQ(spelled.value, key.value) << key.name;
      EXPECT_EQ(spelled.hex_digits, key.hex_digits) << key.name;
      EXPECT_GE(spelled.order, before) << key.name;
      before = spelled.order + 1;
    }
  }
}

TEST(KeyTable, HasNoKeyOfAWholeObjectInASubObject) {
  for (const char* key : {"SubNumber", "CompactSubObj"}) {
    EXPECT_FALSE(spelling_in(SectionKind::sub_object, key).is_known) << key;
    EXPECT_TRUE(spelling_in(SectionKind::object, key).is_known) << key;
  }
}

TEST(KeyTable, PutsAnUnknownKeyAfterTheOthers) {
  for (const KnownSection& section : sections_of_cia306) {
    const KeySpelling unknown = spelling_in(section.kind, "MyOwnKey");
    EXPECT_FALSE(unknown.is_known);
    EXPECT_EQ(unknown.name, "MyOwnKey");
    EXPECT_EQ(unknown.value, ValueKind::text);
    EXPECT_GT(unknown.order, spelling_in(section.kind, section.keys.back().name).order);
  }
}

TEST(KeyTable, SpellsTheTitlesOfCia306) {
  struct Title {
    SectionKind kind;
    std::string_view title;
  };
  // DeviceComissioning is the spelling of the standard.
  for (const Title& row : {Title{SectionKind::file_info, "FileInfo"},
                           {SectionKind::device_info, "DeviceInfo"},
                           {SectionKind::dummy_usage, "DummyUsage"},
                           {SectionKind::comments, "Comments"},
                           {SectionKind::device_commissioning, "DeviceComissioning"},
                           {SectionKind::mandatory_objects, "MandatoryObjects"},
                           {SectionKind::optional_objects, "OptionalObjects"},
                           {SectionKind::manufacturer_objects, "ManufacturerObjects"},
                           {SectionKind::object, "1A00"},
                           {SectionKind::sub_object, "1A00subA"},
                           {SectionKind::compact_names, "1A00Name"},
                           {SectionKind::compact_values, "1A00Value"},
                           {SectionKind::compact_denotations, "1A00Denotation"},
                           {SectionKind::object_links, "1A00ObjectLinks"},
                           {SectionKind::dynamic_channels, "DynamicChannels"},
                           {SectionKind::tools, "Tools"},
                           {SectionKind::tool, "Tool3"},
                           {SectionKind::supported_modules, "SupportedModules"},
                           {SectionKind::module_info, "M3ModuleInfo"},
                           {SectionKind::module_fixed_objects, "M3FixedObjects"},
                           {SectionKind::module_fixed_object, "M3Fixed1A00subA"},
                           {SectionKind::module_sub_extends, "M3SubExtends"},
                           {SectionKind::module_sub_extension, "M3SubExt1A00"},
                           {SectionKind::module_comments, "M3Comments"},
                           {SectionKind::connected_modules, "ConnectedModules"},
                           {SectionKind::malformed, ""},
                           {SectionKind::unknown, ""}}) {
    const SectionName name{
        .kind = row.kind,
        .index = 0x1A00,
        .sub_index = 0xA,
        .number = 3,
        .part = row.kind == SectionKind::module_fixed_object ? SectionKind::sub_object : SectionKind::unknown};
    EXPECT_EQ(spell_section_name(name), row.title);
    EXPECT_EQ(read_section_name(row.title).kind, row.title.empty() ? SectionKind::unknown : row.kind) << row.title;
  }
}

TEST(KeyTable, HasARowForEachSection) {
  for (unsigned kind = 0; kind < static_cast<unsigned>(SectionKind::malformed); ++kind) {
    EXPECT_TRUE(is_known(static_cast<SectionKind>(kind))) << kind;
  }
}

TEST(KeyTable, SpellsEveryKeyThatItKnows) {
  EXPECT_EQ(spelling_in(SectionKind::device_info, "baudrate_500").name, "BaudRate_500");
  EXPECT_EQ(spelling_in(SectionKind::dummy_usage, "dummy001a").name, "Dummy001A");
  EXPECT_EQ(spelling_in(SectionKind::device_commissioning, "nodeid").name, "NodeID");
  EXPECT_FALSE(spelling_in(SectionKind::sub_object, "SubNumber").is_known);
  EXPECT_FALSE(spelling_in(SectionKind::unknown, "ParameterName").is_known);
}

}  // namespace
}  // namespace edsc
