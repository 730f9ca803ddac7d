#include "backend/json/device_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>

#include "backend/json/information_view.hpp"
#include "backend/json/meaning_view.hpp"
#include "backend/json/replaced_default.hpp"
#include "diagnostics/place.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"
#include "values/value_bytes.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using nlohmann::ordered_json;

/// The line of a position; of an overlay and its bases also the file.
void add_line(const Position& position, ordered_json& view) {
  const Position origin = origin_of(position);
  view["line"] = origin.line;
  if (origin.file != position.file) view["file"] = file_name_of(origin.file->name());
}

/// Numbers as numbers, strings as text, OCTET_STRINGs as hexadecimal digits, formulas as `$NODEID+0x180`.
ordered_json value_view(const Value& value, const canopen::DataTypeRow& type) {
  switch (type.kind) {
    case DataClass::boolean: return value.bits != 0;
    case DataClass::signed_integer:
      if (value.plus_node_id) break;
      return static_cast<std::int64_t>(value.bits);
    case DataClass::unsigned_integer:
    case DataClass::time:
      if (value.plus_node_id) break;
      return value.bits;
    case DataClass::real: return real_of(value.bits, type);
    case DataClass::string: return type.type == canopen::DataType::octet_string ? hex_pairs(value.bytes) : value.bytes;
    case DataClass::domain: return nullptr;
  }
  return fmt::format("$NODEID+0x{:X}", value.bits);
}

/// Adds a key only if the data sheet states a value.
void add_text(const char* key, std::string_view text, ordered_json& view) {
  if (!text.empty()) view[key] = text;
}

ordered_json entry_view(const Entry& entry, const Identifiers& names) {
  ordered_json view;
  view["index"] = entry.index;
  view["sub_index"] = entry.sub_index;
  view["name"] = entry.parameter_name();
  view["identifier"] = names.of(entry);
  view["data_type"] = entry.type->name;
  view["bits"] = entry.type->bits;
  if (entry.octets != 0) view["octets"] = entry.octets;
  view["access"] = canopen::row_of(entry.access).name;
  view["pdo_mapping"] = entry.pdo_mapping;
  if (entry.default_value) view["default_value"] = value_view(*entry.default_value, *entry.type);
  if (entry.default_value && !entry.default_value->clause.empty()) {
    view["default_by"] = fmt::format("CiA 301, {}", entry.default_value->clause);
  }
  if (entry.low_limit) view["low_limit"] = value_view(*entry.low_limit, *entry.type);
  if (entry.high_limit) view["high_limit"] = value_view(*entry.high_limit, *entry.type);
  if (entry.obj_flags != 0) view["obj_flags"] = entry.obj_flags;
  add_text("denotation", entry.denotation, view);
  add_text("param_refd", entry.param_refd, view);
  add_text("upload_file", entry.upload_file, view);
  add_text("download_file", entry.download_file, view);
  add_text("unit", entry.unit, view);
  add_text("factor", entry.factor, view);
  add_text("description", entry.description, view);
  if (entry.meaning) view["meaning"] = meaning_view(*entry.meaning, *entry.type);
  add_line(entry.position, view);
  return view;
}

/// A sub-index of a communication parameter, and its key in a PDO.
struct PdoParameter {
  std::uint8_t sub_index;
  const char* key;
};

constexpr PdoParameter pdo_parameters[] = {
    {1, "cob_id"}, {2, "transmission_type"}, {3, "inhibit_time"}, {5, "event_timer"}, {6, "sync_start_value"},
};

/// The default values of the existing communication parameters.
void add_pdo_parameters(const Pdo& pdo, ordered_json& view) {
  for (const PdoParameter& parameter : pdo_parameters) {
    const Entry* const entry = pdo.communication != nullptr ? pdo.communication->find(parameter.sub_index) : nullptr;
    if (entry == nullptr || !entry->default_value) continue;
    const Value& value = *entry->default_value;
    if (parameter.sub_index == 1) view["valid"] = canopen::CobId{static_cast<std::uint32_t>(value.bits)}.valid();
    view[parameter.key] = value_view(value, *entry->type);
  }
}

ordered_json pdo_view(const Pdo& pdo) {
  ordered_json view;
  view["direction"] = pdo.direction == PdoDirection::receive ? "receive" : "transmit";
  view["number"] = pdo.number;
  view["bits"] = pdo.bits();
  view["dynamic"] = pdo.dynamic;
  view["broken"] = pdo.broken;
  add_pdo_parameters(pdo, view);
  add_line(pdo.position, view);
  ordered_json entries = ordered_json::array();
  for (const PdoEntry& entry : pdo.entries) {
    ordered_json row;
    row["index"] = entry.index;
    row["sub_index"] = entry.sub_index;
    row["offset"] = entry.offset;
    row["bits"] = entry.bits;
    row["name"] = entry.object != nullptr  ? entry.object->parameter_name()
                  : entry.dummy != nullptr ? std::string{entry.dummy->name}
                                           : "";
    row["dummy"] = entry.dummy != nullptr;
    entries.push_back(std::move(row));
  }
  view["entries"] = std::move(entries);
  return view;
}

ordered_json type_view(const TypeDefinition& type) {
  const auto name_of = [](const canopen::DataTypeRow* row) {
    return row != nullptr ? ordered_json(row->name) : ordered_json(nullptr);
  };
  ordered_json view;
  view["index"] = type.index;
  view["name"] = type.name;
  if (type.kind == ObjectType::defstruct) {
    ordered_json members = ordered_json::array();
    for (const TypeReference& member : type.members) members.push_back(name_of(member.row));
    view["members"] = std::move(members);
  } else {
    view["data_type"] = name_of(type.type.row);
  }
  if (type.type.octets != 0) view["octets"] = type.type.octets;
  if (type.low_limit) view["low_limit"] = value_view(*type.low_limit, *type.type.row);
  if (type.high_limit) view["high_limit"] = value_view(*type.high_limit, *type.type.row);
  add_line(type.position, view);
  return view;
}

ordered_json object_view(const Object& object, const Identifiers& names) {
  ordered_json view;
  view["index"] = object.index;
  view["object_type"] = to_string(object.type);
  view["name"] = object.parameter_name();
  view["identifier"] = names.of(object);
  add_text("denotation", object.denotation, view);
  if (object.obj_flags != 0) view["obj_flags"] = object.obj_flags;
  if (!object.links.empty()) view["links"] = object.links;
  add_line(object.position, view);
  ordered_json entries = ordered_json::array();
  for (const Entry& entry : object.entries) entries.push_back(entry_view(entry, names));
  view["entries"] = std::move(entries);
  return view;
}

void separate(const Entry& entry, const DataSheet& sheet, const ObjectDescription& object, const Device& device,
              ordered_json& row) {
  const auto configured = replaced_default(entry, sheet, object, device);
  if (!configured) return;
  ordered_json separated;
  for (auto& [key, value] : row.items()) {
    if (key != "default_value") {
      separated[key] = std::move(value);
      continue;
    }
    if (configured->default_value) separated["default_value"] = value_view(*configured->default_value, *entry.type);
    separated["parameter_value"] = std::move(value);
  }
  row = std::move(separated);
}

}  // namespace

ordered_json device_view(const Device& device, const Identifiers& names) {
  ordered_json view;
  view["schema"] = 2;
  view["source"] = file_name_of(device.source->name());
  view["name"] = names.device();
  view["vendor_name"] = device.vendor_name;
  view["vendor_number"] = device.vendor_number;
  view["product_name"] = device.product_name;
  view["product_number"] = device.product_number;
  view["revision_number"] = device.revision_number;
  view["node_id"] = device.node_id ? ordered_json(*device.node_id) : ordered_json(nullptr);
  view["dummies"] = device.dummies;
  add_information(device.information, view);
  ordered_json types = ordered_json::array();
  for (const TypeDefinition& type : device.types) types.push_back(type_view(type));
  view["types"] = std::move(types);
  ordered_json objects = ordered_json::array();
  for (const Object& object : device.objects) objects.push_back(object_view(object, names));
  view["objects"] = std::move(objects);
  ordered_json pdos = ordered_json::array();
  for (const Pdo& pdo : device.pdos) pdos.push_back(pdo_view(pdo));
  view["pdos"] = std::move(pdos);
  view["error_codes"] = error_codes_view(device.error_codes);
  return view;
}

void separate_configured_values(const DataSheet& sheet, const Device& device, ordered_json& view) {
  if (!sheet.is_dcf) return;
  for (ordered_json& object_row : view["objects"]) {
    const auto index = object_row["index"].get<std::uint16_t>();
    const ObjectDescription* const object = sheet.find(index);
    if (object == nullptr) continue;
    for (ordered_json& row : object_row["entries"]) {
      const Entry* const entry = device.find(index, row["sub_index"].get<std::uint8_t>());
      if (entry != nullptr) separate(*entry, sheet, *object, device, row);
    }
  }
}

}  // namespace edsc
