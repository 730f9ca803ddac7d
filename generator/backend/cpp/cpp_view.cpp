#include <fmt/format.h>

#include <algorithm>
#include <canopen/lss/lss_options.hpp>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "backend/cpp/cob_id_view.hpp"
#include "backend/cpp/compiled_format.hpp"
#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/cpp/memory_layout.hpp"
#include "backend/cpp/pdo_view.hpp"
#include "backend/cpp/view.hpp"
#include "device/identifier.hpp"
#include "device/stored_eds.hpp"
#include "text/source_file.hpp"
#include "text/utf8.hpp"

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

/// `text`, padded with blanks to a common column.
std::string padded(std::string text, std::size_t column) {
  if (!is_ascii(text)) return fmt::format("{:<{}}", text, column);  // knows characters of two columns
  text.resize(std::max(text.size(), column), ' ');
  return text;
}

/// The name of an element without its number: "field" for "Field 1", "Field1" and, for sub-index 0Ah, "Field A".
std::string without_number(const Entry& element) {
  const std::string name = to_snake_case(element.name);
  const std::string hexadecimal = fmt::format("{:x}", element.sub_index);
  std::string rest;
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    std::string word = name.substr(begin, end - begin);
    begin = end + 1;
    if (word == hexadecimal || word == "0" + hexadecimal) continue;
    std::erase_if(word, [](char c) { return c >= '0' && c <= '9'; });
    if (!word.empty()) rest += (rest.empty() ? "" : "_") + word;
  }
  return rest;
}

/// Creates the declarations of od:: types.
class ObjectTypes {
 public:
  ObjectTypes(const Device& device, const Options& options) : device_{device}, options_{options} {
    const std::string& path = device.source->name();
    file_ = cpp_comment(path.substr(path.find_last_of('/') + 1));
    for (const Object& object : device.objects) static_cast<void>(names_.take(object.identifier, ""));
  }

  [[nodiscard]] ordered_json view() {
    ordered_json rows = json_array(device_.objects.size());
    for (const Object& object : device_.objects) rows.push_back(object_row(object));
    return rows;
  }

 private:
  [[nodiscard]] ordered_json object_row(const Object& object) {
    if (!object.has_sub_indices()) return json_object("var", entry_row(object.entries.front(), hexadecimal(0)));
    if (describes_uniform_array(object)) return json_object("array", array_row(object));
    return json_object("record", record_row(object));
  }

  [[nodiscard]] ordered_json record_row(const Object& object) const {
    ordered_json entries = json_array(object.entries.size());
    for (const Entry& entry : object.entries) entries.push_back(entry_row(entry, hexadecimal(entry.sub_index)));
    return json_object("identifier", object.identifier, "comment",
                       fmt::format("{}.  {}", cpp_comment(object.name), index_label(object.index)), "entries",
                       std::move(entries));
  }

  [[nodiscard]] ordered_json array_row(const Object& object) {
    const Entry& first = object.entries[1];
    const std::size_t length = object.entries.size() - 1;
    const std::string label = fmt::format("{}:01..{:02X}", index_label(object.index), length);
    ordered_json count = entry_row(object.entries.front(), "0x00");
    count["array_identifier"] = object.identifier;
    return json_object("comment", comment(first, object.name, label), "identifier", object.identifier, "name",
                       cpp_string(object.name), "base", base(first, "SubIndex"), "constants", constants(first),
                       "length", length, "count", std::move(count), "elements", element_names(object));
  }

  /// Elements that have their own name, such as `gains_p` for `gains<1>`; null if there are none.
  [[nodiscard]] ordered_json element_names(const Object& object) {
    std::map<std::string, int> names;
    for (const Entry& entry : object.entries) {
      if (entry.sub_index != 0) ++names[without_number(entry)];
    }
    ordered_json rows = ordered_json::array();
    for (const Entry& entry : object.entries) {
      if (entry.sub_index == 0 || !has_own_name(object, entry, names)) continue;
      const std::string suffix = fmt::format("{:04x}_{:02x}", entry.index, entry.sub_index);
      rows.push_back(json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)),
                                 "identifier", names_.take(element_name(object, entry), suffix), "number",
                                 entry.sub_index));
    }
    if (rows.empty()) return nullptr;
    return json_object("array", object.identifier, "rows", std::move(rows));
  }

  /// Whether the options name an element, or its name differs from those of the object and of the other elements by
  /// more than a number. `names`: the number of elements by name without number.
  [[nodiscard]] bool has_own_name(const Object& object, const Entry& element,
                                  const std::map<std::string, int>& names) const {
    if (options_.names.contains({element.index, element.sub_index})) return true;
    const std::string name = without_number(element);
    if (name.empty() || name == to_snake_case(object.name)) return false;
    if (object.entries.size() == 2) return name == to_snake_case(element.name);
    return names.at(name) == 1;
  }

  [[nodiscard]] static std::string element_name(const Object& object, const Entry& element) {
    std::string name = element.identifier;
    if (name.ends_with('_')) name.pop_back();  // which distinguishes C++ keywords
    return name.starts_with(object.identifier + "_") ? name : object.identifier + "_" + name;
  }

  [[nodiscard]] ordered_json entry_row(const Entry& entry, const std::string& sub_index) const {
    return json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)), "identifier",
                       entry.identifier, "name", cpp_string(entry.name), "base", base(entry, sub_index), "constants",
                       constants(entry));
  }

  [[nodiscard]] static ordered_json constants(const Entry& entry) {
    ordered_json rows = ordered_json::array();
    const auto add = [&](const char* name, const std::optional<Value>& value) {
      if (!value || value->plus_node_id) return;
      rows.push_back(json_object("name", name, "value", cpp_literal(*value, *entry.type)));
    };
    add("low_limit", entry.low_limit);
    add("high_limit", entry.high_limit);
    return rows;
  }

  [[nodiscard]] static std::string hexadecimal(std::uint8_t sub_index) {
    return compiled_format(FMT_COMPILE("0x{:02X}"), sub_index);
  }

  [[nodiscard]] std::string base(const Entry& entry, const std::string& sub_index) const {
    std::string text =
        compiled_format(FMT_COMPILE("canopen::Object<0x{:04X}, {}, {}, canopen::Access::{}"), entry.index, sub_index,
                        cpp_type(entry, options_), access_enumerator(entry.access));
    const bool odd_size =
        (entry.type->kind == DataClass::signed_integer || entry.type->kind == DataClass::unsigned_integer) &&
        entry.type->bits % 8 == 0 && (entry.type->bits & (entry.type->bits - 1)) != 0;
    if (entry.mappable() != Mappable::no || odd_size) {
      text += ", canopen::Mappable::";
      text += mappable_enumerator(entry.mappable());
    }
    if (odd_size) text += fmt::format(", {}", entry.type->bits);
    return text + ">";
  }

  /// `Statusword.  6041h:00  UNSIGNED16  ro  TPDO                cpc-tc1.eds:412`
  [[nodiscard]] std::string comment(const Entry& entry, std::string_view name, const std::string& label) const {
    std::string text = compiled_format(FMT_COMPILE("{}.  {}  {}  {}"), cpp_comment(name), label, entry.type->name,
                                       canopen::row_of(entry.access).name);
    switch (entry.mappable()) {
      case Mappable::no: break;
      case Mappable::tpdo: text += "  TPDO"; break;
      case Mappable::rpdo: text += "  RPDO"; break;
      case Mappable::both: text += "  PDO"; break;
    }
    return compiled_format(FMT_COMPILE("{}  {}:{}"), padded(std::move(text), 78), file_, entry.position.line);
  }

  const Device& device_;
  const Options& options_;
  std::string file_;
  IdentifierScope names_;  ///< of all objects, then of elements
};

// ---- memory layout ----

ordered_json member_view(Member&& member) {
  std::string declaration = compiled_format(FMT_COMPILE("{} {};"), member.type, member.name);
  if (member.comment.empty()) {
    return json_object("declaration", std::move(declaration), "name", std::move(member.name), "initializer",
                       std::move(member.initializer));
  }
  const std::string gap(declaration.size() < 63 ? 64 - declaration.size() : 1, ' ');
  std::string remark = compiled_format(FMT_COMPILE("{}///< {}"), gap, member.comment);
  return json_object("declaration", std::move(declaration), "name", std::move(member.name), "initializer",
                     std::move(member.initializer), "remark", std::move(remark));
}

ordered_json members_view(std::vector<Member>&& members) {
  ordered_json rows = json_array(members.size());
  for (Member& member : members) rows.push_back(member_view(std::move(member)));
  return rows;
}

ordered_json struct_view(Struct&& s) {
  return json_object("type", std::move(s.type), "name", std::move(s.name), "comment", std::move(s.comment), "members",
                     members_view(std::move(s.members)));
}

/// A part of Values.
ordered_json section_view(Struct&& s) {
  const bool preset = s.name.ends_with("preset");
  const bool communication = s.name.starts_with("communication");
  return json_object("type", std::move(s.type), "name", std::move(s.name), "comment", std::move(s.comment), "members",
                     members_view(std::move(s.members)), "preset", preset, "communication", communication);
}

ordered_json row_view(TableRow&& row) {
  if (row.comment.empty()) return json_object("text", std::move(row.text));
  return json_object("text", std::move(row.text), "remark", "  // " + cpp_comment(row.comment));
}

/// A table for the template: its rows, and whether there are any.
ordered_json table_view(std::vector<TableRow>&& rows) {
  ordered_json view = json_array(rows.size());
  for (TableRow& row : rows) view.push_back(row_view(std::move(row)));
  return json_object("any", !rows.empty(), "rows", std::move(view));
}

ordered_json layout_view(MemoryLayout&& layout) {
  ordered_json record_types = json_array(layout.record_types.size());
  for (Struct& s : layout.record_types) record_types.push_back(struct_view(std::move(s)));
  ordered_json values = json_array(layout.values.size());
  for (Struct& section : layout.values) values.push_back(section_view(std::move(section)));
  const bool any_values = !values.empty();
  const bool any_constants = !layout.constants.members.empty();
  return json_object("record_types", std::move(record_types), "values", std::move(values), "any_values", any_values,
                     "constants", struct_view(std::move(layout.constants)), "any_constants", any_constants, "runs",
                     table_view(std::move(layout.runs)), "entries", table_view(std::move(layout.entries)), "groups",
                     table_view(std::move(layout.groups)), "subs", table_view(std::move(layout.subs)), "limits",
                     table_view(std::move(layout.limits)), "wide_limits", table_view(std::move(layout.wide_limits)),
                     "node_id_relative_communication", table_view(std::move(layout.node_id_relative_communication)),
                     "node_id_relative_application", table_view(std::move(layout.node_id_relative_application)),
                     "longest_download", layout.longest_download);
}

// ---- PDOs ----

/// The PDOs that the runtime serves: those with both parameters, and with mapped objects or a dynamic mapping.
ordered_json served_pdos(const Device& device, PdoDirection direction) {
  ordered_json rows = ordered_json::array();
  for (const Pdo& pdo : device.pdos) {
    if (pdo.direction != direction || pdo.communication == nullptr || pdo.mapping == nullptr) continue;
    if (has_wrong_cob_id(pdo)) continue;
    const bool empty = pdo.broken || pdo.entries.empty();
    if (empty && !pdo.dynamic && !pdo.multiplexed) continue;
    const std::string_view kind = direction == PdoDirection::receive ? "Rpdo" : "Tpdo";
    rows.push_back({{"number", pdo.number},
                    {"layout", empty ? fmt::format("canopen::{}<>", kind) : fmt::format("{}{}", kind, pdo.number)},
                    {"separator", rows.empty() ? "" : ","}});
  }
  return rows;
}

// ---- options ----

ordered_json storing_rows(const Options& options) {
  ordered_json rows = json_array(options.storing.size());
  for (const auto& [entry, how] : options.storing) {
    std::string condition = fmt::format("index == 0x{:04X}", entry.index);
    if (entry.sub_index) condition += fmt::format(" && sub_index == 0x{:02X}", *entry.sub_index);
    rows.push_back(json_object("condition", std::move(condition), "storing", how));
  }
  return rows;
}

/// The condition for entries that trigger an event: not in the option no_event.
ordered_json event_conditions(const Options& options) {
  ordered_json rows = json_array(options.no_event.size());
  for (const EntrySelector& entry : options.no_event) {
    std::string condition = fmt::format("index != 0x{:04X}", entry.index);
    if (entry.sub_index) condition = fmt::format("({} || sub_index != 0x{:02X})", condition, *entry.sub_index);
    rows.push_back(json_object("condition", std::move(condition), "separator", rows.empty() ? "" : " &&\n           "));
  }
  return rows;
}

ordered_json emergency_rows(const Options& options) {
  ordered_json rows = json_array(options.emergency_info.size());
  for (const auto& [code, bytes] : options.emergency_info) {
    rows.push_back(json_object("code", fmt::format("0x{:04X}", code), "bytes",
                               fmt::format("{{{{0x{:02X}}}}}", fmt::join(bytes, ", 0x"))));
  }
  return rows;
}

ordered_json runtime_rows(const Options& options) {
  ordered_json rows = json_array(options.runtime.size());
  for (const auto& [name, value] : options.runtime) rows.push_back(json_object("name", name, "value", value));
  return rows;
}

/// The bit rates of the EDS in the format of canopen::LssOptions::bit_rates.
std::uint16_t lss_bit_rates(const Capabilities& capabilities) {
  unsigned mask = 0;
  for (std::size_t i = 0; i < std::size(canopen::lss::bit_rates); ++i) {
    const std::uint16_t rate = canopen::lss::bit_rates[i];
    if (rate != 0 && std::ranges::find(capabilities.baud_rates, rate) != capabilities.baud_rates.end()) mask |= 1u << i;
  }
  return static_cast<std::uint16_t>(mask);
}

/// The members of canopen::LssOptions in its order for a device with LSS; otherwise null.
ordered_json lss_view(const Device& device, const Options& options) {
  const Capabilities& capabilities = device.information.capabilities;
  if (!options.lss && !capabilities.lss_supported.value_or(false)) return nullptr;
  const LssSettings settings = options.lss.value_or(LssSettings{});
  std::string members = fmt::format(".bit_rates = 0x{:04X}", settings.bit_rates.value_or(lss_bit_rates(capabilities)));
  for (const char* flag : lss_flags) {
    if (const auto at = settings.flags.find(flag); at != settings.flags.end()) {
      members += fmt::format(",\n      .{} = {}", flag, at->second);
    }
  }
  return json_object("members", std::move(members));
}

/// The bytes of the EDS as lines of C++ if the device stores it; otherwise null.
ordered_json stored_eds_view(const Device& device, const Options& options) {
  constexpr std::size_t bytes_in_a_line = 24;
  const std::string bytes = stored_eds(device, options);
  if (bytes.empty()) return nullptr;
  ordered_json lines = json_array(bytes.size() / bytes_in_a_line + 1);
  std::string line;
  for (const char byte : bytes) {
    if (line.size() >= bytes_in_a_line * 5) lines.push_back(std::exchange(line, {}));
    line += compiled_format(FMT_COMPILE("0x{:02X},"), static_cast<unsigned char>(byte));
  }
  lines.push_back(std::move(line));
  const bool compressed = options.stored_eds == StoredEds::compressed;
  return json_object("lines", std::move(lines), "what", compressed ? "as a gzip file" : "as text in UTF-8");
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

/// Bit n is set if an RPDO may map data type n as a dummy.
std::string dummy_mask(const Device& device) {
  std::uint32_t mask = 0;
  for (const std::uint16_t dummy : device.dummies) mask |= dummy < 32 ? std::uint32_t{1} << dummy : 0;
  return fmt::format("0x{:04X}", mask);
}

ordered_json description_rows(const Device& device) {
  ordered_json rows = ordered_json::array();
  for (const Object& object : device.objects) {
    const std::string object_name = cpp_string(object.name);
    for (const Entry& entry : object.entries) {
      rows.push_back(compiled_format(FMT_COMPILE("{{0x{:04X}, 0x{:02X}, canopen::DataType::{}, {}, {}}}"), entry.index,
                                     entry.sub_index, type_enumerator(*entry.type), object_name,
                                     object.has_sub_indices() ? cpp_string(entry.name) : "{}"));
    }
  }
  return rows;
}

}  // namespace

ordered_json cpp_view(const Device& device, const Options& options, Diagnostics& diagnostics) {
  const std::string& path = device.source->name();
  ordered_json distinct = distinct_pdos(device);
  ordered_json cob_ids = cob_id_rows(device);
  return json_object("file", cpp_comment(path.substr(path.find_last_of('/') + 1)), "namespace", device.name, "guard",
                     to_upper("edsc_" + device.name), "product_name",
                     cpp_string(device.product_name.empty() ? device.name : device.product_name), "types",
                     ObjectTypes{device, options}.view(), "memory", layout_view(lay_out(device, options, diagnostics)),
                     "zero_terminated_strings", options.zero_terminated_strings, "pdos", pdo_rows(device),
                     "distinct_pdos", json_object("any", !distinct.empty(), "rows", std::move(distinct)), "cob_ids",
                     json_object("any", !cob_ids.empty(), "rows", std::move(cob_ids)), "rpdos",
                     served_pdos(device, PdoDirection::receive), "tpdos", served_pdos(device, PdoDirection::transmit),
                     "options", runtime_rows(options), "any_options", !options.runtime.empty(), "event_conditions",
                     event_conditions(options), "any_event_condition", !options.no_event.empty(), "emergency_info",
                     emergency_rows(options), "any_emergency_info", !options.emergency_info.empty(), "descriptions",
                     description_rows(device), "node_id",
                     device.node_id ? ordered_json(*device.node_id) : ordered_json(nullptr), "dummies",
                     dummy_mask(device), "granularity", device.information.capabilities.granularity.value_or(1), "lss",
                     lss_view(device, options), "stored_eds", stored_eds_view(device, options), "storing",
                     storing_rows(options), "any_storing", !options.storing.empty());
}

}  // namespace edsc
