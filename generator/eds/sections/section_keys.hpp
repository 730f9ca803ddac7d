/// The sections of CiA 306-1 and their keys, one row each: spelling, kind of value and destination, in canonical order.
/// Reader, formatter and `edsc dump` use the same tables.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <tuple>

#include "eds/data_sheet.hpp"
#include "eds/sections/keys.hpp"
#include "eds/sections/numbered_section.hpp"

namespace edsc {

namespace section_keys {

using enum ValueKind;

// Digits of hexadecimal numbers.
inline constexpr std::uint8_t unsigned8 = 2;
inline constexpr std::uint8_t unsigned16 = 4;
inline constexpr std::uint8_t unsigned32 = 8;

inline constexpr KeyRow<FileInfo> file_info_keys[] = {
    {{"FileName"}, &FileInfo::file_name},
    {{"FileVersion"}, &FileInfo::file_version},
    {{"FileRevision"}, &FileInfo::file_revision},
    {{"EDSVersion"}, &FileInfo::eds_version},
    {{"Description"}, &FileInfo::description},
    {{"CreationTime"}, &FileInfo::creation_time},
    {{"CreationDate"}, &FileInfo::creation_date},
    {{"CreatedBy"}, &FileInfo::created_by},
    {{"ModificationTime"}, &FileInfo::modification_time},
    {{"ModificationDate"}, &FileInfo::modification_date},
    {{"ModifiedBy"}, &FileInfo::modified_by},
    {{"LastEDS"}, &FileInfo::last_eds},
};

/// Including rates for which CiA 306 does not define a key.
inline constexpr SectionKey baud_rate_key{"BaudRate_", number, 1, Numbering::c, 0, 0xFFFF};

inline constexpr KeyRow<DeviceInfo> device_info_keys[] = {
    {{"VendorName"}, &DeviceInfo::vendor_name},
    {{"VendorNumber", number, unsigned32}, &DeviceInfo::vendor_number},
    {{"ProductName"}, &DeviceInfo::product_name},
    {{"ProductNumber", number, unsigned32}, &DeviceInfo::product_number},
    {{"RevisionNumber", number, unsigned32}, &DeviceInfo::revision_number},
    {{"OrderCode"}, &DeviceInfo::order_code},
    {baud_rate_key, nullptr},
    {{"SimpleBootUpMaster", number}, &DeviceInfo::simple_boot_up_master},
    {{"SimpleBootUpSlave", number}, &DeviceInfo::simple_boot_up_slave},
    {{"Granularity", number}, &DeviceInfo::granularity},
    {{"DynamicChannelsSupported", number}, &DeviceInfo::dynamic_channels_supported},
    {{"CompactPDO", number}, &DeviceInfo::compact_pdo},
    {{"GroupMessaging", number}, &DeviceInfo::group_messaging},
    {{"NrOfRXPDO", number}, &DeviceInfo::nr_of_rx_pdo},
    {{"NrOfTXPDO", number}, &DeviceInfo::nr_of_tx_pdo},
    {{"LSS_Supported", number}, &DeviceInfo::lss_supported},
    {{"LSS_Master"}, &DeviceInfo::lss_master},
    {{"NG_Slave"}, &DeviceInfo::ng_slave},
    {{"NG_Master"}, &DeviceInfo::ng_master},
    {{"NrOfNG_MonitoredNodes"}, &DeviceInfo::nr_of_ng_monitored_nodes},
    {{"CANopenSafetySupported"}, &DeviceInfo::canopen_safety_supported},
};

inline constexpr KeyRow<DeviceCommissioning> commissioning_keys[] = {
    {{"NodeID", number, unsigned8}, &DeviceCommissioning::node_id},
    {{"NodeName"}, &DeviceCommissioning::node_name},
    {{"NodeRefd"}, &DeviceCommissioning::node_refd},
    {{"Baudrate", number}, &DeviceCommissioning::baudrate},
    {{"NetNumber", number}, &DeviceCommissioning::net_number},
    {{"NetworkName"}, &DeviceCommissioning::network_name},
    {{"NetRefd"}, &DeviceCommissioning::net_refd},
    {{"CANopenManager", number}, &DeviceCommissioning::canopen_manager},
    {{"LSS_SerialNumber", number, unsigned32}, &DeviceCommissioning::lss_serial_number},
};

/// Keys of object and sub-object sections.
inline constexpr KeyRow<EntryDescription> entry_keys[] = {
    {{"ParameterName"}, &EntryDescription::parameter_name},
    {{"ObjectType", number}, &EntryDescription::object_type},
    {{"DataType", number, unsigned16}, &EntryDescription::data_type},
    {{"AccessType", access}, &EntryDescription::access_type},
    {{"LowLimit", typed}, &EntryDescription::low_limit},
    {{"HighLimit", typed}, &EntryDescription::high_limit},
    {{"DefaultValue", typed}, &EntryDescription::default_value},
    {{"ParameterValue", typed}, &EntryDescription::parameter_value},
    {{"PDOMapping", number}, &EntryDescription::pdo_mapping},
    {{"ObjFlags", number}, &EntryDescription::obj_flags},
    {{"Denotation"}, &EntryDescription::denotation},
    {{"UploadFile"}, &EntryDescription::upload_file},
    {{"DownloadFile"}, &EntryDescription::download_file},
    {{"ParamRefd"}, &EntryDescription::param_refd},
    // Not in CiA 306, but usual.
    {{"Unit"}, &EntryDescription::unit},
    {{"Factor"}, &EntryDescription::factor},
    {{"Offset"}, &EntryDescription::offset},
    {{"Description"}, &EntryDescription::description},
};

/// Keys of object sections only, which follow ObjectType.
inline constexpr KeyRow<ObjectDescription> object_keys[] = {
    {{"SubNumber", number}, &ObjectDescription::sub_number},
    {{"CompactSubObj", number}, &ObjectDescription::compact_sub_obj},
};
inline constexpr std::size_t place_of_object_keys = 2;

/// The data types 0001h to 00FFh.
inline constexpr SectionKey dummy_key{"Dummy", number, 1, Numbering::hex4, 0x0001, 0x00FF};
inline constexpr SectionKey dummy_usage_keys[] = {dummy_key};

inline constexpr SectionKey comment_line_count{"Lines", count};
inline constexpr SectionKey comment_line{"Line", text, 1, Numbering::decimal};
inline constexpr SectionKey comments_keys[] = {comment_line_count, comment_line};

// Counted lists.
inline constexpr CountKey supported_objects{"SupportedObjects", "Supported Objects", "object-list-count", true};
inline constexpr CountKey nr_of_entries{"NrOfEntries", {}, "entry-count", false};
inline constexpr CountKey nr_of_list_entries{"NrOfEntries", {}, "entry-count", true};
inline constexpr CountKey object_link_count{"ObjectLinks", {}, "entry-count", true};

inline constexpr SectionKey text_entry{"", text, 1, Numbering::c};
inline constexpr SectionKey typed_entry{"", typed, 1, Numbering::c};
inline constexpr SectionKey number_entry{"", number, 1, Numbering::c};
inline constexpr SectionKey index_entry{"", number, unsigned16, Numbering::c};

inline constexpr SectionKey object_list_keys[] = {{supported_objects.name, count}, index_entry};
inline constexpr SectionKey compact_value_keys[] = {{nr_of_entries.name, count}, typed_entry};
inline constexpr SectionKey compact_text_keys[] = {{nr_of_entries.name, count}, text_entry};
inline constexpr SectionKey object_links_keys[] = {{object_link_count.name, count}, index_entry};
inline constexpr SectionKey index_list_keys[] = {{nr_of_list_entries.name, count}, index_entry};
inline constexpr SectionKey connected_modules_keys[] = {{nr_of_list_entries.name, count}, number_entry};

inline constexpr SectionKey tool_count_key{"Items", parts};
inline constexpr SectionKey tools_keys[] = {tool_count_key};
inline constexpr KeyRow<Tool> tool_keys[] = {{{"Name"}, &Tool::name}, {{"Command"}, &Tool::command}};

inline constexpr SectionKey segment_count_key{"NrOfSeg", parts};

/// Keys of a segment, with its number.
inline constexpr KeyRow<DynamicSegment> segment_keys[] = {
    {{"Type", number, unsigned16, Numbering::decimal}, &DynamicSegment::type},
    {{"Dir", text, 1, Numbering::decimal}, &DynamicSegment::direction},
    {{"Range", index_range, unsigned16, Numbering::decimal}, &DynamicSegment::range},
    {{"PPOffset", number, 1, Numbering::decimal}, &DynamicSegment::process_picture_offset},
};

inline constexpr SectionKey module_count_key{"NrOfEntries", parts};
inline constexpr SectionKey supported_modules_keys[] = {module_count_key};

inline constexpr KeyRow<ModuleDescription> module_info_keys[] = {
    {{"ProductName"}, &ModuleDescription::product_name},
    {{"ProductVersion", number}, &ModuleDescription::product_version},
    {{"ProductRevision", number}, &ModuleDescription::product_revision},
    {{"OrderCode"}, &ModuleDescription::order_code},
};

/// Keys of [MxSubExtHHHH] that follow those of an entry.
inline constexpr KeyRow<SubExtension> sub_extension_keys[] = {
    {{"Count", module_count}, &SubExtension::count},
    {{"ObjExtend", number}, &SubExtension::object_extend},
};

}  // namespace section_keys

/// The keys without their destinations.
template <typename Struct, std::size_t n>
[[nodiscard]] consteval std::array<SectionKey, n> keys_of(const KeyRow<Struct> (&rows)[n]) {
  std::array<SectionKey, n> keys;
  std::ranges::transform(rows, keys.begin(), &KeyRow<Struct>::key);
  return keys;
}

template <std::size_t n, std::size_t m>
[[nodiscard]] consteval std::array<SectionKey, n + m> joined(const std::array<SectionKey, n>& first,
                                                             const std::array<SectionKey, m>& second) {
  std::array<SectionKey, n + m> keys;
  std::ranges::copy(second, std::ranges::copy(first, keys.begin()).out);
  return keys;
}

namespace section_keys {

/// The keys of an object section.
[[nodiscard]] consteval auto all_object_keys() {
  std::array<SectionKey, std::size(entry_keys) + std::size(object_keys)> keys;
  const auto entries = keys_of(entry_keys);
  const auto of_object = keys_of(object_keys);
  const auto middle = std::copy_n(entries.begin(), place_of_object_keys, keys.begin());
  std::copy(entries.begin() + place_of_object_keys, entries.end(), std::ranges::copy(of_object, middle).out);
  return keys;
}

/// The keys of tables with destinations.
template <const auto& rows>
inline constexpr auto names = keys_of(rows);
inline constexpr auto object_names = all_object_keys();
inline constexpr auto segment_names = joined(std::array{segment_count_key}, keys_of(segment_keys));
inline constexpr auto sub_extension_names = joined(keys_of(entry_keys), keys_of(sub_extension_keys));

}  // namespace section_keys

/// Where the title of a section is in its name.
enum class NameForm : std::uint8_t {
  title,          ///< [FileInfo]
  tool,           ///< [Tool1]
  object,         ///< [1003Name]
  module,         ///< [M1ModuleInfo]
  module_index,   ///< [M1SubExt6000]
  module_object,  ///< [M1Fixed6000sub1]: the name of a section of an object follows
};

/// The order in which `edsc format` writes numbered keys.
enum class EntryOrder : std::uint8_t {
  row,     ///< the numbers of one row together, ascending
  number,  ///< the rows of one number together
  file,    ///< the numbers of one row in the order of the file, which the reader keeps
};

struct SectionRow {
  SectionKind kind;
  NameForm form;
  std::string_view title;  ///< as CiA 306 spells it
  std::span<const SectionKey> keys;
  EntryOrder order = EntryOrder::row;
};

/// The sections in canonical order. The sections of objects are after the list to which their object belongs.
inline constexpr SectionRow section_rows[] = {
    {SectionKind::file_info, NameForm::title, "FileInfo", section_keys::names<section_keys::file_info_keys>},
    {SectionKind::device_info, NameForm::title, "DeviceInfo", section_keys::names<section_keys::device_info_keys>},
    {SectionKind::dummy_usage, NameForm::title, "DummyUsage", section_keys::dummy_usage_keys},
    {SectionKind::comments, NameForm::title, "Comments", section_keys::comments_keys},
    // The spelling of the standard.
    {SectionKind::device_commissioning, NameForm::title, "DeviceComissioning",
     section_keys::names<section_keys::commissioning_keys>},
    {SectionKind::mandatory_objects, NameForm::title, "MandatoryObjects", section_keys::object_list_keys},
    {SectionKind::optional_objects, NameForm::title, "OptionalObjects", section_keys::object_list_keys},
    {SectionKind::manufacturer_objects, NameForm::title, "ManufacturerObjects", section_keys::object_list_keys},
    {SectionKind::object, NameForm::object, "", section_keys::object_names},
    {SectionKind::sub_object, NameForm::object, "sub", section_keys::names<section_keys::entry_keys>},
    {SectionKind::compact_names, NameForm::object, "Name", section_keys::compact_text_keys},
    {SectionKind::compact_values, NameForm::object, "Value", section_keys::compact_value_keys},
    {SectionKind::compact_denotations, NameForm::object, "Denotation", section_keys::compact_text_keys},
    {SectionKind::object_links, NameForm::object, "ObjectLinks", section_keys::object_links_keys, EntryOrder::file},
    {SectionKind::dynamic_channels, NameForm::title, "DynamicChannels", section_keys::segment_names,
     EntryOrder::number},
    {SectionKind::tools, NameForm::title, "Tools", section_keys::tools_keys},
    {SectionKind::tool, NameForm::tool, "Tool", section_keys::names<section_keys::tool_keys>},
    {SectionKind::supported_modules, NameForm::title, "SupportedModules", section_keys::supported_modules_keys},
    {SectionKind::module_info, NameForm::module, "ModuleInfo", section_keys::names<section_keys::module_info_keys>},
    {SectionKind::module_fixed_objects, NameForm::module, "FixedObjects", section_keys::index_list_keys},
    // The keys are those of the object section.
    {SectionKind::module_fixed_object, NameForm::module_object, "Fixed", {}},
    {SectionKind::module_sub_extends, NameForm::module, "SubExtends", section_keys::index_list_keys},
    {SectionKind::module_sub_extension, NameForm::module_index, "SubExt", section_keys::sub_extension_names},
    {SectionKind::module_comments, NameForm::module, "Comments", section_keys::comments_keys},
    {SectionKind::connected_modules, NameForm::title, "ConnectedModules", section_keys::connected_modules_keys,
     EntryOrder::file},
};

/// A title that is also read.
struct OtherTitle {
  std::string_view title;
  SectionKind kind;
};

inline constexpr OtherTitle other_titles[] = {{"DeviceCommissioning", SectionKind::device_commissioning}};

/// The place of each section kind in `section_rows`; their number for unknown and malformed names.
inline constexpr auto section_places = [] {
  std::array<std::uint8_t, static_cast<std::size_t>(SectionKind::unknown) + 1> places{};
  places.fill(static_cast<std::uint8_t>(std::size(section_rows)));
  for (std::size_t i = 0; i < std::size(section_rows); ++i) {
    places[static_cast<std::size_t>(section_rows[i].kind)] = static_cast<std::uint8_t>(i);
  }
  return places;
}();

/// The place of a section in the canonical order; after all others for unknown and malformed names.
[[nodiscard]] constexpr std::uint32_t place_of_section(SectionKind kind) {
  return section_places[static_cast<std::size_t>(kind)];
}

/// The row of a section, or null for unknown and malformed names.
[[nodiscard]] constexpr const SectionRow* find_section(SectionKind kind) {
  const std::uint32_t place = place_of_section(kind);
  return place < std::size(section_rows) ? &section_rows[place] : nullptr;
}

/// The values of a section in `edsc dump`.
enum class Dumped : std::uint8_t {
  by_member,  ///< from members of `Information`, see `information_rows`
  by_key,     ///< as a member of `sections`, from the rows of its keys
};

/// A section that occurs once and whose keys do not depend on each other. It is read from its row and its keys alone.
template <typename Struct, std::size_t n>
struct PlainSection {
  SectionKind kind;
  Struct DataSheet::*member;
  const KeyRow<Struct> (&keys)[n];
  WarningRule rule;  ///< for a value that is not a number
  Dumped dumped;
};

template <typename Struct, std::size_t n>
PlainSection(SectionKind, Struct DataSheet::*, const KeyRow<Struct> (&)[n], WarningRule, Dumped)
    -> PlainSection<Struct, n>;

inline constexpr std::tuple plain_sections{
    PlainSection{SectionKind::file_info, &DataSheet::file_info, section_keys::file_info_keys, "device-info",
                 Dumped::by_member},
    PlainSection{SectionKind::device_info, &DataSheet::device_info, section_keys::device_info_keys, "device-info",
                 Dumped::by_member},
    PlainSection{SectionKind::device_commissioning, &DataSheet::commissioning, section_keys::commissioning_keys,
                 "commissioning", Dumped::by_member},
};

using section_keys::all_object_keys, section_keys::baud_rate_key, section_keys::commissioning_keys,
    section_keys::device_info_keys, section_keys::dummy_key, section_keys::entry_keys, section_keys::file_info_keys,
    section_keys::comment_line, section_keys::comment_line_count, section_keys::module_count_key,
    section_keys::module_info_keys, section_keys::nr_of_entries, section_keys::nr_of_list_entries,
    section_keys::object_keys, section_keys::object_link_count, section_keys::segment_count_key,
    section_keys::segment_keys, section_keys::sub_extension_keys, section_keys::supported_objects,
    section_keys::text_entry, section_keys::tool_count_key, section_keys::tool_keys;

}  // namespace edsc
