#include <fmt/format.h>

#include "render/cpp_text.hpp"
#include "render/memory_layout.hpp"
#include "render/view.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::Mappable;
using nlohmann::ordered_json;

std::string_view access_enumerator(canopen::Access access) {
  return access == canopen::Access::constant ? "constant" : canopen::row_of(access).name;
}

std::string_view mappable_enumerator(Mappable mappable) {
  switch (mappable) {
    case Mappable::no: return "no";
    case Mappable::tpdo: return "tpdo";
    case Mappable::rpdo: return "rpdo";
    case Mappable::both: return "both";
  }
  return "no";
}

/// Makes the declarations of od:: types.
class ObjectTypes {
 public:
  ObjectTypes(const Device& device, const Options& options) : device_{device}, options_{options} {
    const std::string& path = device.source->name();
    file_ = cpp_comment(path.substr(path.find_last_of('/') + 1));
  }

  [[nodiscard]] ordered_json view() const {
    ordered_json rows = ordered_json::array();
    for (const Object& object : device_.objects) rows.push_back(object_row(object));
    return rows;
  }

 private:
  [[nodiscard]] ordered_json object_row(const Object& object) const {
    ordered_json row;
    if (!object.has_sub_indices()) {
      row["var"] = entry_row(object.entries.front(), fmt::format("0x{:02X}", 0));
    } else if (describes_uniform_array(object)) {
      row["array"] = array_row(object);
    } else {
      row["record"] = record_row(object);
    }
    return row;
  }

  [[nodiscard]] ordered_json record_row(const Object& object) const {
    ordered_json row;
    row["identifier"] = object.identifier;
    row["comment"] = fmt::format("{}.  {}", cpp_comment(object.name), index_label(object.index));
    ordered_json entries = ordered_json::array();
    for (const Entry& entry : object.entries) entries.push_back(entry_row(entry, fmt::format("0x{:02X}", entry.sub_index)));
    row["entries"] = std::move(entries);
    return row;
  }

  [[nodiscard]] ordered_json array_row(const Object& object) const {
    ordered_json row = entry_row(object.entries[1], "SubIndex");
    row["identifier"] = object.identifier;
    row["name"] = cpp_string(object.name);
    row["length"] = object.entries.size() - 1;
    row["comment"] = comment(object.entries[1], object.name,
                             fmt::format("{}:01..{:02X}", index_label(object.index), object.entries.size() - 1));
    row["count"] = entry_row(object.entries.front(), "0x00");
    row["count"]["array_identifier"] = object.identifier;
    return row;
  }

  [[nodiscard]] ordered_json entry_row(const Entry& entry, const std::string& sub_index) const {
    ordered_json row;
    row["comment"] = comment(entry, entry.name, entry_label(entry.index, entry.sub_index));
    row["identifier"] = entry.identifier;
    row["name"] = cpp_string(entry.name);
    row["base"] = base(entry, sub_index);
    ordered_json constants = ordered_json::array();
    const auto constant = [&](const char* name, const std::optional<Value>& value) {
      if (!value || value->plus_node_id) return;
      constants.push_back({{"name", name}, {"value", cpp_literal(*value, *entry.type)}});
    };
    constant("low_limit", entry.low_limit);
    constant("high_limit", entry.high_limit);
    row["constants"] = std::move(constants);
    return row;
  }

  [[nodiscard]] std::string base(const Entry& entry, const std::string& sub_index) const {
    std::string text = fmt::format("canopen::Object<0x{:04X}, {}, {}, canopen::Access::{}", entry.index, sub_index,
                                   cpp_type(entry, options_), access_enumerator(entry.access));
    const bool odd_size = (entry.type->kind == DataClass::signed_integer || entry.type->kind == DataClass::unsigned_integer) &&
                          entry.type->bits % 8 == 0 && (entry.type->bits & (entry.type->bits - 1)) != 0;
    if (entry.mappable() != Mappable::no || odd_size) {
      text += fmt::format(", canopen::Mappable::{}", mappable_enumerator(entry.mappable()));
    }
    if (odd_size) text += fmt::format(", {}", entry.type->bits);
    return text + ">";
  }

  /// `Statusword.  6041h:00  UNSIGNED16  ro  TPDO                cpc-tc1.eds:412`
  [[nodiscard]] std::string comment(const Entry& entry, std::string_view name, const std::string& label) const {
    std::string text = fmt::format("{}.  {}  {}  {}", cpp_comment(name), label, entry.type->name,
                                   canopen::row_of(entry.access).name);
    switch (entry.mappable()) {
      case Mappable::no: break;
      case Mappable::tpdo: text += "  TPDO"; break;
      case Mappable::rpdo: text += "  RPDO"; break;
      case Mappable::both: text += "  PDO"; break;
    }
    return fmt::format("{:<78}  {}:{}", text, file_, entry.position.line);
  }

  const Device& device_;
  const Options& options_;
  std::string file_;
};

// ---- memory layout ----

/// Spaces that bring a comment to a common column.
std::string padding(std::size_t length, std::size_t column) { return std::string(length < column ? column - length : 1, ' '); }

ordered_json struct_view(const Struct& s) {
  ordered_json view;
  view["type"] = s.type;
  view["name"] = s.name;
  view["comment"] = s.comment;
  ordered_json members = ordered_json::array();
  for (const Member& m : s.members) {
    ordered_json row;
    const std::string declaration = fmt::format("{} {};", m.type, m.name);
    row["declaration"] = declaration;
    row["name"] = m.name;
    row["initializer"] = m.initializer;
    if (!m.comment.empty()) row["remark"] = padding(declaration.size(), 64) + "///< " + m.comment;
    members.push_back(std::move(row));
  }
  view["members"] = std::move(members);
  return view;
}

ordered_json rows_view(const std::vector<TableRow>& rows) {
  ordered_json view = ordered_json::array();
  for (const TableRow& row : rows) {
    ordered_json line;
    line["text"] = row.text;
    if (!row.comment.empty()) line["remark"] = "  // " + cpp_comment(row.comment);
    view.push_back(std::move(line));
  }
  return view;
}

/// A table for the template: its rows, and whether there are any.
void add_table(ordered_json& view, const char* name, const std::vector<TableRow>& rows) {
  view[name] = {{"any", !rows.empty()}, {"rows", rows_view(rows)}};
}

ordered_json layout_view(const MemoryLayout& layout) {
  ordered_json view;
  view["record_types"] = ordered_json::array();
  for (const Struct& s : layout.record_types) view["record_types"].push_back(struct_view(s));
  ordered_json values = ordered_json::array();
  for (const Struct& s : layout.values) {
    ordered_json section = struct_view(s);
    section["preset"] = s.name.ends_with("preset");
    section["communication"] = s.name.starts_with("communication");
    values.push_back(std::move(section));
  }
  view["values"] = std::move(values);
  view["any_values"] = !layout.values.empty();
  view["constants"] = struct_view(layout.constants);
  view["any_constants"] = !layout.constants.members.empty();
  add_table(view, "runs", layout.runs);
  add_table(view, "entries", layout.entries);
  add_table(view, "groups", layout.groups);
  add_table(view, "subs", layout.subs);
  add_table(view, "limits", layout.limits);
  add_table(view, "wide_limits", layout.wide_limits);
  add_table(view, "node_id_relative_communication", layout.node_id_relative_communication);
  add_table(view, "node_id_relative_application", layout.node_id_relative_application);
  view["longest_download"] = layout.longest_download;
  return view;
}

// ---- PDOs ----

/// The type of a mapped object, without regard to its length in the PDO.
std::string mapped_object(const Device& device, const PdoEntry& entry) {
  const Object& object = *device.find(entry.index);
  if (!object.has_sub_indices()) return fmt::format("od::{}", object.identifier);
  if (describes_uniform_array(object) && entry.sub_index > 0) {
    return fmt::format("od::{}<{}>", object.identifier, entry.sub_index);
  }
  if (describes_uniform_array(object)) return fmt::format("od::{}<0>", object.identifier);
  return fmt::format("od::{}::{}", object.identifier, entry.object->identifier);
}

std::string pdo_entry_type(const Device& device, const PdoEntry& entry) {
  if (entry.dummy != nullptr) return fmt::format("canopen::Dummy<0x{:04X}, {}>", entry.index, entry.bits);
  const std::string object = mapped_object(device, entry);
  return entry.bits == entry.object->type->bits ? object : fmt::format("canopen::Padded<{}, {}>", object, entry.bits);
}

ordered_json pdo_rows(const Device& device) {
  ordered_json rows = ordered_json::array();
  for (const Pdo& pdo : device.pdos) {
    if (pdo.mapping == nullptr) continue;
    const bool receive = pdo.direction == PdoDirection::receive;
    const std::uint16_t offset = static_cast<std::uint16_t>(pdo.number - 1);
    ordered_json row;
    row["label"] = pdo_label(pdo);
    row["type"] = fmt::format("{}{}", receive ? "Rpdo" : "Tpdo", pdo.number);
    row["template"] = receive ? "canopen::Rpdo" : "canopen::Tpdo";
    row["communication"] = index_label(static_cast<std::uint16_t>((receive ? 0x1400 : 0x1800) + offset));
    row["mapping"] = index_label(static_cast<std::uint16_t>((receive ? 0x1600 : 0x1A00) + offset));
    row["broken"] = pdo.broken;
    row["bits"] = pdo.bits();
    ordered_json entries = ordered_json::array();
    unsigned at = 0;
    for (const PdoEntry& entry : pdo.entries) {
      if (pdo.broken) break;
      const std::string name = entry.dummy != nullptr ? "(dummy)" : cpp_comment(entry.object->name);
      const auto* type = entry.dummy != nullptr ? entry.dummy : entry.object->type;
      entries.push_back({{"object", pdo_entry_type(device, entry)},
                         {"separator", entries.empty() ? "" : ", "},
                         {"bit_range", fmt::format("{:>2}..{:<2}", at, at + entry.bits - 1)},
                         {"description", fmt::format("{}  {}  {}", entry_label(entry.index, entry.sub_index), type->name, name)}});
      at += entry.bits;
    }
    row["entries"] = std::move(entries);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The PDOs that the runtime serves: those with both parameters and something in them.
ordered_json served_pdos(const Device& device, PdoDirection direction) {
  ordered_json rows = ordered_json::array();
  for (const Pdo& pdo : device.pdos) {
    if (pdo.direction != direction || pdo.broken || pdo.entries.empty()) continue;
    if (pdo.communication == nullptr || pdo.mapping == nullptr) continue;
    rows.push_back({{"number", pdo.number}, {"separator", rows.empty() ? "" : ","}});
  }
  return rows;
}

/// The enumerator of canopen::DataType: its name in lower case.
std::string type_enumerator(const canopen::DataTypeRow& type) {
  std::string out{type.name};
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string to_upper(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return text;
}

ordered_json description_rows(const Device& device) {
  ordered_json rows = ordered_json::array();
  for (const Object& object : device.objects) {
    for (const Entry& entry : object.entries) {
      rows.push_back({{"text", fmt::format("{{0x{:04X}, 0x{:02X}, canopen::DataType::{}, {}, {}}}", entry.index, entry.sub_index,
                                           type_enumerator(*entry.type), cpp_string(object.name),
                                           object.has_sub_indices() ? cpp_string(entry.name) : "{}")}});
    }
  }
  return rows;
}

}  // namespace

ordered_json cpp_view(const Device& device, const Options& options, Diagnostics& diagnostics) {
  const std::string& path = device.source->name();
  ordered_json view;
  view["file"] = cpp_comment(path.substr(path.find_last_of('/') + 1));
  view["namespace"] = device.name;
  view["guard"] = to_upper("edsc_" + device.name);
  view["product_name"] = cpp_string(device.product_name.empty() ? device.name : device.product_name);
  view["types"] = ObjectTypes{device, options}.view();
  view["memory"] = layout_view(lay_out(device, options, diagnostics));
  view["zero_terminated_strings"] = options.zero_terminated_strings;
  view["pdos"] = pdo_rows(device);
  view["rpdos"] = served_pdos(device, PdoDirection::receive);
  view["tpdos"] = served_pdos(device, PdoDirection::transmit);
  ordered_json runtime = ordered_json::array();
  for (const auto& [name, value] : options.runtime) runtime.push_back({{"name", name}, {"value", value}});
  view["options"] = std::move(runtime);
  view["any_options"] = !options.runtime.empty();
  view["descriptions"] = description_rows(device);
  if (device.node_id) view["node_id"] = *device.node_id;
  return view;
}

}  // namespace edsc
