/// The data sheet: an EDS or DCF as it was written, sorted into the sections of CiA 306-1, nothing resolved yet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/ini.hpp"

namespace edsc {

/// The value of a key as it was spelled, and where. `present` is false when the section has no such key; then
/// `position` is that of the section.
struct Field {
  std::string_view text;
  Position position;
  bool present = false;

  [[nodiscard]] bool empty() const { return text.empty(); }
};

/// The keys of an object or sub-object section (CiA 306-1, clause 4.6.2).
struct EntryDescription {
  Position position;  ///< of the section's name
  Field parameter_name;
  Field denotation;
  Field object_type;
  Field data_type;
  Field access_type;
  Field low_limit;
  Field high_limit;
  Field default_value;
  Field parameter_value;
  Field pdo_mapping;
  Field obj_flags;
  Field upload_file;
  Field download_file;
};

struct SubObjectDescription : EntryDescription {
  std::uint8_t sub_index = 0;
};

/// `number=text` of the sections [xxxxName], [xxxxValue] and [xxxxDenotation].
struct NumberedField {
  std::uint32_t number = 0;
  Field field;
};

struct ObjectDescription : EntryDescription {
  std::uint16_t index = 0;
  bool has_section = true;  ///< false when only sub-object sections name this index
  Field sub_number;
  Field compact_sub_obj;
  std::vector<SubObjectDescription> sub_objects;  ///< ascending, each sub-index once
  std::vector<NumberedField> compact_names;
  std::vector<NumberedField> compact_values;
  std::vector<NumberedField> compact_denotations;
};

enum class ObjectListKind : std::uint8_t { mandatory, optional, manufacturer };

struct ListedObject {
  ObjectListKind list = ObjectListKind::mandatory;
  std::uint16_t index = 0;
  Position position;
};

/// [FileInfo], clause 4.4.
struct FileInfo {
  Field file_name, file_version, file_revision, eds_version, description, created_by;
};

/// [DeviceInfo], clause 4.5.
struct DeviceInfo {
  Position position;
  bool present = false;
  Field vendor_name, vendor_number, product_name, product_number, revision_number, order_code;
  Field simple_boot_up_master, simple_boot_up_slave, granularity, dynamic_channels_supported, group_messaging;
  Field nr_of_rx_pdo, nr_of_tx_pdo, lss_supported, compact_pdo;
  struct BaudRate {
    std::uint16_t kbit_per_second;
    Field field;
  };
  std::vector<BaudRate> baud_rates;  ///< those that have a key, whatever its value
};

/// [DeviceComissioning] of a DCF, clause 5.3.
struct DeviceCommissioning {
  bool present = false;
  Position position;
  Field node_id, node_name, baudrate, net_number, network_name, canopen_manager, lss_serial_number;
};

struct DataSheet {
  const SourceFile* source = nullptr;
  bool is_dcf = false;  ///< it has [DeviceComissioning], or its name ends in .dcf
  FileInfo file_info;
  DeviceInfo device_info;
  DeviceCommissioning commissioning;
  /// [DummyUsage]: `DummyNNNN=1`, by the data type's index 0001h..00FFh.
  std::vector<NumberedField> dummy_usage;
  std::vector<ListedObject> listed;        ///< in the order of the lists
  std::vector<ObjectDescription> objects;  ///< ascending by index, each index once
};

/// Sorts an INI file into a data sheet. Everything that cannot be placed is reported; the first of two sections or keys
/// of the same name wins.
[[nodiscard]] DataSheet read_data_sheet(const IniFile& ini, Diagnostics& diagnostics);

}  // namespace edsc
