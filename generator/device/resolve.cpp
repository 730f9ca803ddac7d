#include "device/resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "device/identifier.hpp"
#include "device/resolve_pdos.hpp"
#include "device/value.hpp"
#include "eds/number.hpp"
#include "text/ini.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataClass;
using canopen::DataType;
using canopen::DataTypeRow;

Value number_value(std::uint64_t bits, const Position& position) {
  Value value;
  value.bits = bits;
  value.position = position;
  return value;
}

/// Indices below this describe data types, not values.
constexpr std::uint16_t first_communication_index = 0x1000;

/// Predefined complex data types (CiA 301, 7.4.7, table 44): PDO parameters, SDO parameter, identity, ...
constexpr std::uint64_t first_complex_type = 0x20;
constexpr std::uint64_t last_complex_type = 0x3F;

class Resolver {
 public:
  Resolver(const DataSheet& sheet, const Options& options, const ResolveSettings& settings, Diagnostics& diagnostics)
      : sheet_{sheet}, options_{options}, settings_{settings}, diagnostics_{diagnostics} {}

  Device resolve() {
    device_.source = sheet_.source;
    device_.name = settings_.name.empty() ? namespace_of(sheet_.source->name()) : settings_.name;
    device_.node_id = settings_.node_id ? settings_.node_id : commissioned_node_id();
    resolve_device_info();
    for (const NumberedField& dummy : sheet_.dummy_usage) {
      if (parse_unsigned(strip_inline_comment(dummy.field.text)).value_or(0) != 0) {
        device_.dummies.push_back(static_cast<std::uint16_t>(dummy.number));
      }
    }
    for (const ObjectDescription& object : sheet_.objects) {
      if (auto resolved = resolve_object(object)) {
        (object.index < first_communication_index ? device_.types : device_.objects).push_back(std::move(*resolved));
      }
    }
    name_objects();
    check_option_keys();
    resolve_pdos(device_);
    return std::move(device_);
  }

 private:
  static std::string namespace_of(const std::string& file) {
    return to_namespace(std::filesystem::path{file}.stem().string());
  }

  /// NodeID of a DCF: a configured device knows its number. 0 and 255 mean none.
  std::optional<std::uint8_t> commissioned_node_id() {
    const Field& field = sheet_.commissioning.node_id;
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) return std::nullopt;
    const auto number = parse_unsigned(text);
    if (number && *number >= 1 && *number <= 127) return static_cast<std::uint8_t>(*number);
    if (!number || (*number != 0 && *number != 255)) {
      diagnostics_.error("node-id", field.position, fmt::format("NodeID \"{}\" is not in 1..127", text.substr(0, 60)));
    }
    return std::nullopt;
  }

  void resolve_device_info() {
    const DeviceInfo& info = sheet_.device_info;
    device_.vendor_name = info.vendor_name.text;
    device_.product_name = info.product_name.text;
    device_.vendor_number = device_info_number(info.vendor_number);
    device_.product_number = device_info_number(info.product_number);
    device_.revision_number = device_info_number(info.revision_number);
  }

  std::uint32_t device_info_number(const Field& field) {
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) return 0;
    const auto number = parse_unsigned(text);
    if (!number || *number > 0xFFFF'FFFF) {
      diagnostics_.warning("device-info", field.position, fmt::format("\"{}\" is no UNSIGNED32; 0 is taken", text.substr(0, 60)));
      return 0;
    }
    return static_cast<std::uint32_t>(*number);
  }

  // ---- objects ----

  std::optional<Object> resolve_object(const ObjectDescription& description) {
    Object object;
    object.index = description.index;
    object.position = description.position;
    object.name = description.parameter_name.text;
    object.type = object_type(description);
    if (object.name.empty()) {
      diagnostics_.warning("parameter-name", description.position, "an object without ParameterName");
    }
    if (object.has_sub_indices()) {
      resolve_sub_objects(description, object);
    } else if (object.type == ObjectType::deftype || object.type == ObjectType::defstruct) {
      return object;
    } else if (auto entry = resolve_entry(description, {description.index, 0, false}, object.name)) {
      object.entries.push_back(std::move(*entry));
    }
    if (object.entries.empty()) return std::nullopt;
    return object;
  }

  ObjectType object_type(const ObjectDescription& description) {
    const bool has_subs = !description.sub_objects.empty() || compact_count(description) > 0;
    const ObjectType fallback = has_subs ? ObjectType::record : ObjectType::var;
    const Field& field = description.object_type;
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) {
      if (has_subs) {
        diagnostics_.warning("object-type", description.position,
                             "no ObjectType, but sub-objects: taken for a RECORD");
      }
      return fallback;
    }
    const auto number = parse_unsigned(text);
    const auto known = {ObjectType::domain, ObjectType::deftype, ObjectType::defstruct,
                        ObjectType::var,    ObjectType::array,   ObjectType::record};
    for (const ObjectType type : known) {
      if (number != static_cast<std::uint64_t>(type)) continue;
      const bool simple = type == ObjectType::var || type == ObjectType::domain;
      if (!simple || !has_subs) return type;
      diagnostics_.warning("object-type", field.position,
                           fmt::format("a {} has no sub-objects: taken for a RECORD", to_string(type)));
      return ObjectType::record;
    }
    diagnostics_.warning("object-type", field.position,
                         fmt::format("\"{}\" is no object code of CiA 301: taken for a {}", text.substr(0, 60),
                                     to_string(fallback)));
    return fallback;
  }

  static std::uint64_t compact_count(const ObjectDescription& description) {
    return parse_unsigned(strip_inline_comment(description.compact_sub_obj.text)).value_or(0);
  }

  void check_compact_count(const Field& field) {
    const std::string_view text = strip_inline_comment(field.text);
    if (text.empty() || parse_unsigned(text)) return;
    diagnostics_.error("compact-sub-obj", field.position,
                       fmt::format("CompactSubObj \"{}\" is not a number", text.substr(0, 60)));
  }

  void resolve_sub_objects(const ObjectDescription& description, Object& object) {
    check_compact_count(description.compact_sub_obj);
    if (compact_count(description) > 0) {
      resolve_compact(description, object);
    } else {
      for (const SubObjectDescription& sub : description.sub_objects) {
        if (auto entry = resolve_entry(sub, {description.index, sub.sub_index, true}, sub.parameter_name.text)) {
          object.entries.push_back(std::move(*entry));
        }
      }
    }
    if (object.entries.empty()) {
      diagnostics_.warning("no-sub-objects", description.position,
                           fmt::format("{} {} has no sub-objects and is left out", to_string(object.type),
                                       index_label(object.index)));
      return;
    }
    check_sub_number(description);
    supply_sub_index_0(description, object);
  }

  /// CompactSubObj: sub-indices 1..N of one type, described by the object's own section (CiA 306-1, 4.6.2.6).
  void resolve_compact(const ObjectDescription& description, Object& object) {
    std::uint64_t count = compact_count(description);
    if (count > 254) {
      diagnostics_.warning("compact-sub-obj", description.compact_sub_obj.position,
                           "CompactSubObj is 254 at most: 254 is taken");
      count = 254;
    }
    object.entries.push_back(count_entry(description, static_cast<std::uint8_t>(count)));
    for (std::uint32_t i = 1; i <= count; ++i) {
      EntryDescription element = description;
      element.object_type = {};
      if (const Field* value = numbered(description.compact_values, i)) element.default_value = *value;
      const Field* name = numbered(description.compact_names, i);
      std::string element_name =
          name != nullptr ? std::string{name->text} : fmt::format("{}{}", description.parameter_name.text, i);
      for (const SubObjectDescription& sub : description.sub_objects) {
        if (sub.sub_index != i) continue;
        element = sub;
        if (!sub.parameter_name.empty()) element_name = sub.parameter_name.text;
      }
      if (auto entry = resolve_entry(element, {description.index, static_cast<std::uint8_t>(i), true}, element_name)) {
        object.entries.push_back(std::move(*entry));
      }
    }
  }

  static const Field* numbered(const std::vector<NumberedField>& fields, std::uint32_t number) {
    for (const NumberedField& field : fields) {
      if (field.number == number) return &field.field;
    }
    return nullptr;
  }

  /// Sub-index 0 of a compact object, or of one whose data sheet forgot it.
  static Entry count_entry(const ObjectDescription& description, std::uint8_t highest) {
    Entry entry;
    entry.index = description.index;
    entry.name = "Highest sub-index supported";
    entry.type = canopen::find_data_type(static_cast<std::uint32_t>(DataType::unsigned8));
    entry.access = Access::constant;
    entry.default_value = number_value(highest, description.position);
    entry.position = entry.access_position = entry.mapping_position = description.position;
    return entry;
  }

  void check_sub_number(const ObjectDescription& description) {
    const Field& field = description.sub_number;
    if (!field.present || compact_count(description) > 0) return;
    const auto number = parse_unsigned(strip_inline_comment(field.text));
    if (number && *number == description.sub_objects.size()) return;
    diagnostics_.warning("sub-number", field.position,
                         fmt::format("SubNumber is {}, but {} sub-objects are described; those count",
                                     strip_inline_comment(field.text), description.sub_objects.size()));
  }

  void supply_sub_index_0(const ObjectDescription& description, Object& object) {
    const std::uint8_t highest = object.entries.back().sub_index;
    if (object.entries.front().sub_index != 0) {
      diagnostics_.warning("sub-index-0", description.position,
                           fmt::format("{} has no sub-index 0; one with the value {} is supplied",
                                       index_label(object.index), highest));
      object.entries.insert(object.entries.begin(), count_entry(description, highest));
    } else if (!object.entries.front().default_value && highest > 0) {
      object.entries.front().default_value = number_value(highest, object.entries.front().position);
    }
  }

  // ---- entries ----

  struct EntryPlace {
    std::uint16_t index;
    std::uint8_t sub_index;
    bool in_object_with_sub_indices;
  };

  std::optional<Entry> resolve_entry(const EntryDescription& description, EntryPlace place, std::string_view name) {
    Entry entry;
    entry.index = place.index;
    entry.sub_index = place.sub_index;
    entry.name = name;
    entry.position = description.position;
    entry.access_position = description.access_type.present ? description.access_type.position : description.position;
    entry.mapping_position = description.pdo_mapping.present ? description.pdo_mapping.position : description.position;
    if (place.in_object_with_sub_indices && place.sub_index != 0) check_sub_object_type(description);
    entry.type = data_type(description, place);
    if (entry.type == nullptr) return std::nullopt;
    entry.access = access(description);
    entry.pdo_mapping = pdo_mapping(description);
    resolve_values(description, entry);
    return entry;
  }

  void check_sub_object_type(const EntryDescription& description) {
    const std::string_view text = strip_inline_comment(description.object_type.text);
    if (text.empty()) return;
    const auto type = parse_unsigned(text);
    if (type == static_cast<std::uint64_t>(ObjectType::var) || type == static_cast<std::uint64_t>(ObjectType::domain)) return;
    diagnostics_.warning("object-type", description.object_type.position, "a sub-object is a VAR or a DOMAIN: taken for one");
  }

  const DataTypeRow* data_type(const EntryDescription& description, const EntryPlace& place) {
    const Field& field = description.data_type;
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) return missing_data_type(description, place);
    const auto code = parse_unsigned(text);
    if (!code) {
      diagnostics_.error("data-type", field.position, fmt::format("DataType \"{}\" is not a number", text.substr(0, 60)));
      return nullptr;
    }
    if (const DataTypeRow* row = canopen::find_data_type(static_cast<std::uint32_t>(std::min<std::uint64_t>(*code, 0xFFFF'FFFF)))) {
      return row;
    }
    if (const DataTypeRow* row = defined_type(*code)) return row;
    if (*code >= first_complex_type && *code <= last_complex_type) {
      diagnostics_.warning("complex-data-type", field.position,
                           fmt::format("DataType 0x{:04X} is a RECORD's, not a value's; the entry is left out", *code));
      return nullptr;
    }
    diagnostics_.error("data-type", field.position, fmt::format("DataType 0x{:04X} is no basic data type of CiA 301, and no DEFTYPE of this file", *code));
    return nullptr;
  }

  static bool is_mapping_parameter(std::uint16_t index) {
    return (index >= 0x1600 && index <= 0x17FF) || (index >= 0x1A00 && index <= 0x1BFF);
  }

  const DataTypeRow* missing_data_type(const EntryDescription& description, const EntryPlace& place) {
    const auto type = parse_unsigned(strip_inline_comment(description.object_type.text));
    if (type == static_cast<std::uint64_t>(ObjectType::domain)) {
      diagnostics_.warning("data-type", description.position, "no DataType: a DOMAIN by its ObjectType");
      return canopen::find_data_type(static_cast<std::uint32_t>(DataType::domain));
    }
    if (place.in_object_with_sub_indices && place.sub_index == 0) {
      diagnostics_.warning("data-type", description.position, "sub-index 0 without DataType: taken for an UNSIGNED8");
      return canopen::find_data_type(static_cast<std::uint32_t>(DataType::unsigned8));
    }
    if (is_mapping_parameter(place.index)) {
      diagnostics_.warning("data-type", description.position, "a mapping entry without DataType: taken for an UNSIGNED32");
      return canopen::find_data_type(static_cast<std::uint32_t>(DataType::unsigned32));
    }
    diagnostics_.error("data-type", description.position, "no DataType");
    return nullptr;
  }

  /// A DEFTYPE of this file (CiA 306-1, 4.6.3), followed to the basic type that it stands for.
  const DataTypeRow* defined_type(std::uint64_t code) {
    for (int depth = 0; depth < 8; ++depth) {
      const auto at = std::ranges::find_if(sheet_.objects, [&](const ObjectDescription& o) { return o.index == code; });
      if (at == sheet_.objects.end() || at->index >= first_communication_index) return nullptr;
      const auto next = parse_unsigned(strip_inline_comment(at->data_type.text));
      if (!next) return nullptr;
      if (const DataTypeRow* row = canopen::find_data_type(static_cast<std::uint32_t>(std::min<std::uint64_t>(*next, 0xFFFF'FFFF)))) {
        return row;
      }
      code = *next;
    }
    return nullptr;
  }

  Access access(const EntryDescription& description) {
    const Field& field = description.access_type;
    const std::string_view text = strip_inline_comment(field.text);
    for (const canopen::AccessRow& row : canopen::access_rows) {
      if (equal_ignoring_case(text, row.name)) return row.access;
    }
    if (!field.present || text.empty()) {
      diagnostics_.warning("access-type", description.position, "no AccessType: taken for rw");
    } else {
      diagnostics_.error("access-type", field.position,
                         fmt::format("AccessType \"{}\" is none of ro, wo, rw, rwr, rww, const", text.substr(0, 60)));
    }
    return Access::rw;
  }

  bool pdo_mapping(const EntryDescription& description) {
    const Field& field = description.pdo_mapping;
    const std::string_view text = strip_inline_comment(field.text);
    if (!field.present || text.empty()) return false;
    const auto number = parse_unsigned(text);
    if (number && *number <= 1) return *number == 1;
    diagnostics_.warning("pdo-mapping", field.position,
                         fmt::format("PDOMapping is 0 or 1, not \"{}\"; {} is taken", text.substr(0, 60), number ? 1 : 0));
    return number.has_value();
  }

  void resolve_values(const EntryDescription& description, Entry& entry) {
    const bool configured = description.parameter_value.present && !description.parameter_value.empty();
    if (configured && !sheet_.is_dcf) {
      diagnostics_.warning("parameter-value", description.parameter_value.position,
                           "ParameterValue belongs into a DCF; in an EDS the DefaultValue counts");
    }
    entry.default_value = parse_value(configured && sheet_.is_dcf ? description.parameter_value : description.default_value,
                                      *entry.type, device_.node_id, diagnostics_);
    const bool numeric = entry.type->kind == DataClass::signed_integer || entry.type->kind == DataClass::unsigned_integer ||
                         entry.type->kind == DataClass::real;
    if (numeric) {
      entry.low_limit = parse_value(description.low_limit, *entry.type, device_.node_id, diagnostics_);
      entry.high_limit = parse_value(description.high_limit, *entry.type, device_.node_id, diagnostics_);
    }
  }

  // ---- names ----

  void name_objects() {
    IdentifierScope scope;
    for (Object& object : device_.objects) {
      object.identifier = scope.take(identifier(object.name, object.index, 0), fmt::format("{:04x}", object.index));
      if (!object.has_sub_indices()) {
        object.entries.front().identifier = object.identifier;
        continue;
      }
      IdentifierScope sub_scope;
      for (Entry& entry : object.entries) {
        const bool own_name = entry.sub_index != 0 || entry.name != object.name;
        entry.identifier = sub_scope.take(
            own_name ? identifier(entry.name, entry.index, entry.sub_index) : "highest_sub_index_supported",
            fmt::format("{:02x}", entry.sub_index));
      }
    }
  }

  /// The options' name, else the one made from ParameterName, else one made from the index.
  [[nodiscard]] std::string identifier(std::string_view name, std::uint16_t index, std::uint8_t sub_index) const {
    if (const auto at = options_.names.find({index, sub_index}); at != options_.names.end()) return at->second;
    std::string made = to_snake_case(name);
    if (made.empty()) made = sub_index == 0 ? fmt::format("object_{:04x}", index) : fmt::format("sub_{:02x}", sub_index);
    return made;
  }

  /// Options must speak of entries that exist.
  void check_option_keys() {
    const auto check = [&](const EntryKey& key, std::string_view option) {
      if (device_.find(key.first, key.second) != nullptr) return;
      diagnostics_.error("options", Position{sheet_.source},
                         fmt::format("option {} names {}, which is not in the data sheet", option,
                                     entry_label(key.first, key.second)));
    };
    for (const auto& [key, name] : options_.names) check(key, "names");
    for (const auto& [key, capacity] : options_.string_capacity) check(key, "string_capacity");
    for (const EntryKey& key : options_.settable) check(key, "settable");
  }

  const DataSheet& sheet_;
  const Options& options_;
  const ResolveSettings& settings_;
  Diagnostics& diagnostics_;
  Device device_;
};

}  // namespace

Device resolve_device(const DataSheet& sheet, const Options& options, const ResolveSettings& settings,
                      Diagnostics& diagnostics) {
  return Resolver{sheet, options, settings, diagnostics}.resolve();
}

}  // namespace edsc
