/// The keys of [FileInfo], [DeviceInfo], [DeviceComissioning] and others that a Device keeps as typed values, one row
/// each: name in the JSON view, key of the data sheet, value. In the order of the JSON view.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/information.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// `to` is a text, which is copied unchanged, an optional number or an optional flag.
template <typename Source, typename Target, typename Value>
struct InformationRow {
  const char* name;
  Field Source::*from;
  Value Target::*to;
};

namespace information_rows {

using Number = std::optional<std::uint32_t>;
using Flag = std::optional<bool>;

inline constexpr InformationRow<FileInfo, FileInformation, std::string> file_texts[] = {
    {"file_name", &FileInfo::file_name, &FileInformation::file_name},
    {"file_version", &FileInfo::file_version, &FileInformation::file_version},
    {"file_revision", &FileInfo::file_revision, &FileInformation::file_revision},
    {"eds_version", &FileInfo::eds_version, &FileInformation::eds_version},
    {"description", &FileInfo::description, &FileInformation::description},
    {"creation_time", &FileInfo::creation_time, &FileInformation::creation_time},
    {"creation_date", &FileInfo::creation_date, &FileInformation::creation_date},
    {"created_by", &FileInfo::created_by, &FileInformation::created_by},
    {"modification_time", &FileInfo::modification_time, &FileInformation::modification_time},
    {"modification_date", &FileInfo::modification_date, &FileInformation::modification_date},
    {"modified_by", &FileInfo::modified_by, &FileInformation::modified_by},
    {"last_eds", &FileInfo::last_eds, &FileInformation::last_eds},
};

inline constexpr InformationRow<DeviceInfo, Capabilities, Flag> device_flags[] = {
    {"simple_boot_up_master", &DeviceInfo::simple_boot_up_master, &Capabilities::simple_boot_up_master},
    {"simple_boot_up_slave", &DeviceInfo::simple_boot_up_slave, &Capabilities::simple_boot_up_slave},
    {"group_messaging", &DeviceInfo::group_messaging, &Capabilities::group_messaging},
    {"lss_supported", &DeviceInfo::lss_supported, &Capabilities::lss_supported},
};

inline constexpr InformationRow<DeviceInfo, Capabilities, Number> device_numbers[] = {
    {"granularity", &DeviceInfo::granularity, &Capabilities::granularity},
    {"dynamic_channels_supported", &DeviceInfo::dynamic_channels_supported, &Capabilities::dynamic_channels_supported},
    {"nr_of_rx_pdo", &DeviceInfo::nr_of_rx_pdo, &Capabilities::nr_of_rx_pdo},
    {"nr_of_tx_pdo", &DeviceInfo::nr_of_tx_pdo, &Capabilities::nr_of_tx_pdo},
    {"compact_pdo", &DeviceInfo::compact_pdo, &Capabilities::compact_pdo},
};

inline constexpr InformationRow<DeviceCommissioning, Commissioning, std::string> commissioning_texts[] = {
    {"node_name", &DeviceCommissioning::node_name, &Commissioning::node_name},
    {"network_name", &DeviceCommissioning::network_name, &Commissioning::network_name},
    {"node_refd", &DeviceCommissioning::node_refd, &Commissioning::node_refd},
    {"net_refd", &DeviceCommissioning::net_refd, &Commissioning::net_refd},
};

inline constexpr InformationRow<DeviceCommissioning, Commissioning, Number> commissioning_numbers[] = {
    {"baudrate", &DeviceCommissioning::baudrate, &Commissioning::baudrate},
    {"net_number", &DeviceCommissioning::net_number, &Commissioning::net_number},
    {"lss_serial_number", &DeviceCommissioning::lss_serial_number, &Commissioning::lss_serial_number},
};

inline constexpr InformationRow<DeviceCommissioning, Commissioning, Flag> commissioning_flags[] = {
    {"canopen_manager", &DeviceCommissioning::canopen_manager, &Commissioning::canopen_manager},
};

inline constexpr InformationRow<ModuleDescription, ModuleInformation, Number> module_numbers[] = {
    {"product_version", &ModuleDescription::product_version, &ModuleInformation::product_version},
    {"product_revision", &ModuleDescription::product_revision, &ModuleInformation::product_revision},
};

}  // namespace information_rows

}  // namespace edsc
