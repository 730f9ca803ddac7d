/// The data sheet: an EDS or DCF as written, sorted into the sections of CiA 306-1, unresolved. An XDD or XDC of CiA
/// 311 is read into the same structure.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// The sections of CiA 306-1. Their names, keys and order are the rows of `section_rows`.
enum class SectionKind : std::uint8_t {
  file_info,
  device_info,
  dummy_usage,
  comments,
  device_commissioning,
  mandatory_objects,
  optional_objects,
  manufacturer_objects,
  object,               ///< [1018]
  sub_object,           ///< [1018sub1]
  compact_names,        ///< [1003Name]
  compact_values,       ///< [1003Value]
  compact_denotations,  ///< [1003Denotation]
  object_links,         ///< [1003ObjectLinks]
  tools,
  tool,  ///< [Tool1]
  dynamic_channels,
  supported_modules,
  connected_modules,
  module_info,           ///< [M1ModuleInfo]
  module_comments,       ///< [M1Comments]
  module_fixed_objects,  ///< [M1FixedObjects]
  module_fixed_object,   ///< [M1Fixed6000], [M1Fixed6000sub1] and the other sections of objects
  module_sub_extends,    ///< [M1SubExtends]
  module_sub_extension,  ///< [M1SubExt6000]
  malformed,             ///< meant for an object, but without a valid index or sub-index
  unknown,               ///< the last one
};

/// The value of a key as written, with its position. `present` is false if the section does not have the key;
/// `position` is then that of the section.
struct Field {
  std::string_view text;
  Position position;
  bool present = false;

  [[nodiscard]] bool empty() const { return text.empty(); }
};

/// A name for a value, from an enumeration or the allowed values of an XDD.
struct ValueName {
  Field value, name;
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
  Field param_refd;
  Field unit, factor, offset, description;  ///< not of CiA 306, but widely used
  std::vector<ValueName> value_names;       ///< of an XDD
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
  bool has_section = true;  ///< false if only sub-object sections have this index
  Field sub_number;
  Field compact_sub_obj;
  std::vector<SubObjectDescription> sub_objects;  ///< ascending, each sub-index once
  std::vector<NumberedField> compact_names;
  std::vector<NumberedField> compact_values;
  std::vector<NumberedField> compact_denotations;
  std::vector<NumberedField> object_links;

  [[nodiscard]] const SubObjectDescription* find(std::uint64_t sub_index) const;
};

enum class ObjectListKind : std::uint8_t { mandatory, optional, manufacturer };

struct ListedObject {
  ObjectListKind list = ObjectListKind::mandatory;
  std::uint16_t index = 0;
  Position position;
};

/// [FileInfo], clause 4.4.
struct FileInfo {
  Position position;
  bool present = false;
  Field file_name, file_version, file_revision, eds_version, description, created_by;
  Field creation_time, creation_date, modification_time, modification_date, modified_by;
  Field last_eds;  ///< of a DCF: the EDS it was made from
};

/// [DeviceInfo], clause 4.5.
struct DeviceInfo {
  Position position;
  bool present = false;
  Field vendor_name, vendor_number, product_name, product_number, revision_number, order_code;
  Field simple_boot_up_master, simple_boot_up_slave, granularity, dynamic_channels_supported, group_messaging;
  Field nr_of_rx_pdo, nr_of_tx_pdo, lss_supported, compact_pdo;
  Field lss_master, ng_slave, ng_master, nr_of_ng_monitored_nodes, canopen_safety_supported;
  struct BaudRate {
    std::uint16_t kbit_per_second;
    Field field;
  };
  std::vector<BaudRate> baud_rates;  ///< those that have a key, regardless of its value
};

/// [DeviceComissioning] of a DCF, clause 5.3.
struct DeviceCommissioning {
  bool present = false;
  Position position;
  Field node_id, node_name, baudrate, net_number, network_name, canopen_manager, lss_serial_number;
  Field node_refd, net_refd;
};

/// [Comments] and [MxComments], clause 4.7.
struct Comments {
  bool present = false;
  Field lines;
  std::vector<NumberedField> text;  ///< `LineN`, ascending
};

/// [ToolX] of the [Tools].
struct Tool {
  std::uint16_t number = 0;
  Field name, command;
};

/// A segment of the [DynamicChannels], clause 4.8: network variables of a programmable device.
struct DynamicSegment {
  std::uint32_t number = 0;
  Field type, direction, range, process_picture_offset;
};

struct DynamicChannels {
  bool present = false;
  Field nr_of_segments;
  std::vector<DynamicSegment> segments;  ///< ascending
};

/// [MxSubExtHHHH]: sub-indices that each module adds to an object, clause 6.
struct SubExtension : EntryDescription {
  std::uint16_t index = 0;
  Field count;          ///< `n`, or `0;m`: m bits of a sub-index that several modules share
  Field object_extend;  ///< the highest sub-index before the next index is used
};

/// The sections of module x, clause 6.
struct ModuleDescription {
  std::uint16_t number = 0;
  Position position;
  Field product_name, product_version, product_revision, order_code;
  Comments comments;
  std::vector<NumberedField> fixed_objects;
  std::vector<ObjectDescription> objects;  ///< [MxFixedHHHH], ascending
  std::vector<NumberedField> sub_extends;
  std::vector<SubExtension> sub_extensions;  ///< ascending
};

/// The supported and the connected modules of a modular device.
struct Modules {
  Field nr_of_entries;
  std::vector<ModuleDescription> supported;  ///< ascending
  std::vector<NumberedField> connected;      ///< of a DCF: the module number at each place
};

/// The keys with the values of an entry; null for an element of a compact form without its own section.
struct ValueFields {
  const Field* default_value = nullptr;
  const Field* parameter_value = nullptr;
};

struct DataSheet {
  const SourceFile* source = nullptr;
  bool is_dcf = false;  ///< it has [DeviceComissioning], or its name ends in .dcf or .xdc
  FileInfo file_info;
  DeviceInfo device_info;
  DeviceCommissioning commissioning;
  Comments comments;
  std::vector<Tool> tools;  ///< ascending
  DynamicChannels dynamic_channels;
  Modules modules;
  /// [DummyUsage]: `DummyNNNN=1`, by the data type's index 0001h..00FFh.
  std::vector<NumberedField> dummy_usage;
  std::vector<ListedObject> listed;        ///< in the order of the lists
  std::vector<ObjectDescription> objects;  ///< ascending by index, each index once
  /// Texts that fields point to and that do not occur in the source in this form. Copies of the data sheet share them.
  std::shared_ptr<const std::deque<std::string>> texts;

  /// The description of an object, or null.
  [[nodiscard]] const ObjectDescription* find(std::uint64_t index) const;

  /// The values of a sub-index of an object of this data sheet, or of a VAR. Those of a compact form are
  /// ParameterValues in a DCF, and default values in an EDS (CiA 306-1, 5).
  [[nodiscard]] ValueFields values_of(const ObjectDescription& object, std::uint8_t sub_index,
                                      bool has_sub_indices) const;
};

/// Sorts an INI file into a data sheet. Unknown sections and keys are reported; of duplicate sections or keys, the
/// first is used.
[[nodiscard]] DataSheet read_data_sheet(const IniFile& ini, Diagnostics& diagnostics);

}  // namespace edsc
