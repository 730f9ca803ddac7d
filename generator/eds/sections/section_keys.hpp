/// The keys of CiA 306-1, one row each: spelling, kind of value and destination, in canonical order. Reader and
/// formatter use the same tables.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

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

inline constexpr KeyRow<DeviceInfo> device_info_keys[] = {
    {{"VendorName"}, &DeviceInfo::vendor_name},
    {{"VendorNumber", number, unsigned32}, &DeviceInfo::vendor_number},
    {{"ProductName"}, &DeviceInfo::product_name},
    {{"ProductNumber", number, unsigned32}, &DeviceInfo::product_number},
    {{"RevisionNumber", number, unsigned32}, &DeviceInfo::revision_number},
    {{"OrderCode"}, &DeviceInfo::order_code},
    {{"BaudRate_#", number}, nullptr},
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
    {{"Description"}, &EntryDescription::description},
};

/// Keys of object sections only, which follow ObjectType.
inline constexpr KeyRow<ObjectDescription> object_keys[] = {
    {{"SubNumber", number}, &ObjectDescription::sub_number},
    {{"CompactSubObj", number}, &ObjectDescription::compact_sub_obj},
};
inline constexpr std::size_t place_of_object_keys = 2;

inline constexpr std::string_view baud_rate_prefix = "BaudRate_";

inline constexpr SectionKey dummy_usage_keys[] = {{"Dummy%", number}};
inline constexpr SectionKey comments_keys[] = {{"Lines"}, {"Line#"}};

// Counted lists.
inline constexpr CountKey supported_objects{"SupportedObjects", "Supported Objects", "object-list-count", true};
inline constexpr CountKey nr_of_entries{"NrOfEntries", {}, "entry-count", false};
inline constexpr CountKey object_link_count{"ObjectLinks", {}, "entry-count", true};

inline constexpr SectionKey object_list_keys[] = {{supported_objects.name, count}, {"#", number, unsigned16}};
inline constexpr SectionKey compact_value_keys[] = {{nr_of_entries.name, count}, {"#", typed}};
inline constexpr SectionKey compact_text_keys[] = {{nr_of_entries.name, count}, {"#"}};
inline constexpr SectionKey object_links_keys[] = {{object_link_count.name, count}, {"#", number, unsigned16}};

}  // namespace section_keys

using section_keys::baud_rate_prefix, section_keys::comments_keys, section_keys::commissioning_keys,
    section_keys::compact_text_keys, section_keys::compact_value_keys, section_keys::device_info_keys,
    section_keys::dummy_usage_keys, section_keys::entry_keys, section_keys::file_info_keys, section_keys::nr_of_entries,
    section_keys::object_keys, section_keys::object_link_count, section_keys::object_links_keys,
    section_keys::object_list_keys, section_keys::place_of_object_keys, section_keys::supported_objects;

/// The keys without their destinations.
template <typename Struct, std::size_t n>
[[nodiscard]] consteval std::array<SectionKey, n> keys_of(const KeyRow<Struct> (&rows)[n]) {
  std::array<SectionKey, n> keys;
  std::ranges::transform(rows, keys.begin(), &KeyRow<Struct>::key);
  return keys;
}

/// The keys of an object section.
[[nodiscard]] consteval auto all_object_keys() {
  std::array<SectionKey, std::size(entry_keys) + std::size(object_keys)> keys;
  const auto entries = keys_of(entry_keys);
  const auto of_object = keys_of(object_keys);
  const auto middle = std::copy_n(entries.begin(), place_of_object_keys, keys.begin());
  std::copy(entries.begin() + place_of_object_keys, entries.end(), std::ranges::copy(of_object, middle).out);
  return keys;
}

}  // namespace edsc
