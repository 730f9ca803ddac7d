/// The contents of a data sheet other than objects, as typed values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace edsc {

/// [FileInfo] (CiA 306-1, clause 4.4). Dates and times are unchanged texts.
struct FileInformation {
  std::string file_name, file_version, file_revision, eds_version, description;
  std::string creation_time, creation_date, created_by;
  std::string modification_time, modification_date, modified_by;
  std::string last_eds;
};

/// [DeviceInfo] (clause 4.5) without the identity, which is in `Device`. Nothing for a missing or invalid key.
struct Capabilities {
  std::string order_code;
  std::vector<std::uint16_t> baud_rates;  ///< kbit/s, supported ones
  std::optional<bool> simple_boot_up_master, simple_boot_up_slave, group_messaging, lss_supported;
  std::optional<std::uint32_t> granularity, dynamic_channels_supported, nr_of_rx_pdo, nr_of_tx_pdo, compact_pdo;
};

/// [DeviceComissioning] of a DCF (clause 5.3) without the node-ID, which is in `Device`.
struct Commissioning {
  std::string node_name, network_name, node_refd, net_refd;
  std::optional<std::uint32_t> baudrate, net_number, lss_serial_number;
  std::optional<bool> canopen_manager;
};

struct ToolInformation {
  std::string name, command;
};

/// A segment of the [DynamicChannels] (clause 4.8).
struct DynamicChannel {
  std::optional<std::uint32_t> data_type, first_index, last_index, process_picture_offset;
  std::string direction;
};

/// The modules of a modular device (clause 6).
struct ModuleInformation {
  std::uint16_t number = 0;
  std::string product_name, order_code;
  std::optional<std::uint32_t> product_version, product_revision;
  std::vector<std::string> comments;
};

/// A value of a section, by its key as CiA 306 spells it.
struct SectionValue {
  std::string_view key;
  std::variant<std::string, std::uint32_t> value;
};

/// The values of a section that does not have its own members.
struct SectionValues {
  std::string_view title;
  std::vector<SectionValue> values;
};

struct Information {
  FileInformation file;
  Capabilities capabilities;
  std::optional<Commissioning> commissioning;
  std::vector<std::string> comments;
  std::vector<ToolInformation> tools;
  std::vector<DynamicChannel> dynamic_channels;
  std::vector<ModuleInformation> supported_modules;
  std::vector<std::uint16_t> connected_modules;  ///< by place, from the DCF or the options
  std::vector<SectionValues> sections;           ///< other sections with independent keys
};

}  // namespace edsc
