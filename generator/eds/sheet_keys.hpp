/// The keys of CiA 306-1 and their destinations: one row per key, for reading and writing sections.
#pragma once

#include <span>
#include <string_view>

#include "eds/data_sheet.hpp"
#include "eds/keys.hpp"

namespace edsc {

inline constexpr KeyRow<FileInfo> file_info_rows[] = {
    {"FileName", &FileInfo::file_name},
    {"FileVersion", &FileInfo::file_version},
    {"FileRevision", &FileInfo::file_revision},
    {"EDSVersion", &FileInfo::eds_version},
    {"Description", &FileInfo::description},
    {"CreatedBy", &FileInfo::created_by},
    {"CreationTime", &FileInfo::creation_time},
    {"CreationDate", &FileInfo::creation_date},
    {"ModificationTime", &FileInfo::modification_time},
    {"ModificationDate", &FileInfo::modification_date},
    {"ModifiedBy", &FileInfo::modified_by},
    {"LastEDS", &FileInfo::last_eds},
};

inline constexpr KeyRow<DeviceInfo> device_info_rows[] = {
    {"VendorName", &DeviceInfo::vendor_name},
    {"VendorNumber", &DeviceInfo::vendor_number},
    {"ProductName", &DeviceInfo::product_name},
    {"ProductNumber", &DeviceInfo::product_number},
    {"RevisionNumber", &DeviceInfo::revision_number},
    {"OrderCode", &DeviceInfo::order_code},
    {"SimpleBootUpMaster", &DeviceInfo::simple_boot_up_master},
    {"SimpleBootUpSlave", &DeviceInfo::simple_boot_up_slave},
    {"Granularity", &DeviceInfo::granularity},
    {"DynamicChannelsSupported", &DeviceInfo::dynamic_channels_supported},
    {"GroupMessaging", &DeviceInfo::group_messaging},
    {"NrOfRXPDO", &DeviceInfo::nr_of_rx_pdo},
    {"NrOfTXPDO", &DeviceInfo::nr_of_tx_pdo},
    {"LSS_Supported", &DeviceInfo::lss_supported},
    {"CompactPDO", &DeviceInfo::compact_pdo},
    {"LSS_Master", &DeviceInfo::lss_master},
    {"NG_Slave", &DeviceInfo::ng_slave},
    {"NG_Master", &DeviceInfo::ng_master},
    {"NrOfNG_MonitoredNodes", &DeviceInfo::nr_of_ng_monitored_nodes},
    {"CANopenSafetySupported", &DeviceInfo::canopen_safety_supported},
};

inline constexpr KeyRow<DeviceCommissioning> commissioning_rows[] = {
    {"NodeID", &DeviceCommissioning::node_id},
    {"NodeName", &DeviceCommissioning::node_name},
    {"Baudrate", &DeviceCommissioning::baudrate},
    {"NetNumber", &DeviceCommissioning::net_number},
    {"NetworkName", &DeviceCommissioning::network_name},
    {"CANopenManager", &DeviceCommissioning::canopen_manager},
    {"LSS_SerialNumber", &DeviceCommissioning::lss_serial_number},
    {"NodeRefd", &DeviceCommissioning::node_refd},
    {"NetRefd", &DeviceCommissioning::net_refd},
};

inline constexpr std::span<const KeyRow<FileInfo>> file_info_keys = file_info_rows;
inline constexpr std::span<const KeyRow<DeviceInfo>> device_info_keys = device_info_rows;
inline constexpr std::span<const KeyRow<DeviceCommissioning>> commissioning_keys = commissioning_rows;

/// Keys of object and sub-object sections; the frequent ones first.
inline constexpr KeyRow<EntryDescription> entry_rows[] = {
    {"ParameterName", &EntryDescription::parameter_name},
    {"ObjectType", &EntryDescription::object_type},
    {"DataType", &EntryDescription::data_type},
    {"AccessType", &EntryDescription::access_type},
    {"DefaultValue", &EntryDescription::default_value},
    {"PDOMapping", &EntryDescription::pdo_mapping},
    {"LowLimit", &EntryDescription::low_limit},
    {"HighLimit", &EntryDescription::high_limit},
    {"ObjFlags", &EntryDescription::obj_flags},
    {"ParameterValue", &EntryDescription::parameter_value},
    {"Denotation", &EntryDescription::denotation},
    {"UploadFile", &EntryDescription::upload_file},
    {"DownloadFile", &EntryDescription::download_file},
    {"ParamRefd", &EntryDescription::param_refd},
    {"Unit", &EntryDescription::unit},
    {"Factor", &EntryDescription::factor},
    {"Description", &EntryDescription::description},
};

/// Keys of object sections only.
inline constexpr KeyRow<ObjectDescription> object_rows[] = {
    {"SubNumber", &ObjectDescription::sub_number},
    {"CompactSubObj", &ObjectDescription::compact_sub_obj},
};

inline constexpr std::span<const KeyRow<EntryDescription>> entry_keys = entry_rows;
inline constexpr std::span<const KeyRow<ObjectDescription>> object_keys = object_rows;

inline constexpr std::string_view baud_rate_prefix = "BaudRate_";

}  // namespace edsc
