#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/cpp/placement.hpp"
#include "device/drive_modes.hpp"
#include "system/path.hpp"
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
  const std::string name = to_cpp_identifier(element.name);
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

class ObjectTypes {
 public:
  ObjectTypes(const NamedDevice& named, const Options& options)
      : device_{named.device}, names_{named.names}, options_{options} {
    file_ = cpp_comment(file_name_of(device_.source->name()));
    for (const Object& object : device_.objects) static_cast<void>(scope_.take(names_.of(object), ""));
  }

  [[nodiscard]] ordered_json view() {
    ordered_json rows = json_array(device_.objects.size());
    for (const Object& object : device_.objects) rows.push_back(object_row(object));
    return rows;
  }

 private:
  [[nodiscard]] ordered_json object_row(const Object& object) {
    const bool is_var = !object.has_sub_indices();
    const bool is_array = !is_var && describes_uniform_array(object);
    return json_object("var", is_var ? entry_row(object.entries.front()) : nullptr,  //
                       "array", is_array ? array_row(object) : nullptr,              //
                       "record", is_var || is_array ? nullptr : record_row(object));
  }

  [[nodiscard]] ordered_json record_row(const Object& object) const {
    ordered_json entries = json_array(object.entries.size());
    for (const Entry& entry : object.entries) entries.push_back(entry_row(entry));
    return json_object("identifier", names_.of(object), "comment",
                       fmt::format("{}.  {}", cpp_comment(object.name), index_label(object.index)), "entries",
                       std::move(entries));
  }

  [[nodiscard]] ordered_json array_row(const Object& object) {
    const Entry& first = object.entries[1];
    const std::size_t length = object.entries.size() - 1;
    const std::string label = fmt::format("{}:01..{:02X}", index_label(object.index), length);
    ordered_json count = entry_row(object.entries.front());
    count["array_identifier"] = names_.of(object);
    return json_object(
        "comment", comment(first, object.name, label), "identifier", names_.of(object), "name", cpp_string(object.name),
        "base", fmt::format("canopen::Object<{}, SubIndex, {}>", index_of(first), attributes(first)), "constants",
        constants(first), "length", length, "count", std::move(count), "elements", element_names(object));
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
                                 "identifier", scope_.take(element_name(object, entry), suffix), "number",
                                 entry.sub_index));
    }
    if (rows.empty()) return nullptr;
    return json_object("array", names_.of(object), "rows", std::move(rows));
  }

  /// Whether the options name an element, or its name differs from those of the object and of the other elements by
  /// more than a number. `names`: the number of elements by name without number.
  [[nodiscard]] bool has_own_name(const Object& object, const Entry& element,
                                  const std::map<std::string, int>& names) const {
    if (options_.names.contains({element.index, element.sub_index})) return true;
    const std::string name = without_number(element);
    if (name.empty() || name == to_cpp_identifier(object.name)) return false;
    if (object.entries.size() == 2) return name == to_cpp_identifier(element.name);
    return names.at(name) == 1;
  }

  [[nodiscard]] std::string element_name(const Object& object, const Entry& element) const {
    const std::string& name = names_.identifiers().of(element);
    return name.starts_with(names_.of(object) + "_") ? name : names_.of(object) + "_" + name;
  }

  [[nodiscard]] ordered_json entry_row(const Entry& entry) const {
    return json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)), "identifier",
                       names_.of(entry), "name", cpp_string(entry.name), "base",
                       fmt::format("canopen::TypedObject<{}>", attributes(entry)), "index", index_of(entry),
                       "sub_index", fmt::format("0x{:02X}", entry.sub_index), "constants", constants(entry),
                       "accepted_modes", modes(entry));
  }

  /// `{{0, 1}, {3, 3}}`: the modes of operation that an entry accepts; null if it accepts all values.
  [[nodiscard]] ordered_json modes(const Entry& entry) const {
    std::string ranges;
    for (const ModeRange& range : accepted_modes(device_, options_, entry)) {
      ranges += fmt::format("{}{{{}, {}}}", ranges.empty() ? "" : ", ", range.low, range.high);
    }
    if (ranges.empty()) return nullptr;
    return json_object("ranges", "{" + ranges + "}");
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

  [[nodiscard]] static std::string index_of(const Entry& entry) { return fmt::format("0x{:04X}", entry.index); }

  /// The arguments of canopen::TypedObject.
  [[nodiscard]] std::string attributes(const Entry& entry) const {
    std::string text =
        fmt::format("{}, canopen::Access::{}", cpp_type(entry, options_), access_enumerator(entry.access));
    const bool odd_size =
        (entry.type->kind == DataClass::signed_integer || entry.type->kind == DataClass::unsigned_integer) &&
        entry.type->bits % 8 == 0 && (entry.type->bits & (entry.type->bits - 1)) != 0;
    if (entry.mappable() != Mappable::no || odd_size) {
      text += ", canopen::Mappable::";
      text += mappable_enumerator(entry.mappable());
    }
    if (odd_size) text += fmt::format(", {}", entry.type->bits);
    return text;
  }

  /// `Statusword.  6041h:00  UNSIGNED16  ro  TPDO                cpc-tc1.eds:412`
  [[nodiscard]] std::string comment(const Entry& entry, std::string_view name, const std::string& label) const {
    std::string text =
        fmt::format("{}.  {}  {}  {}", cpp_comment(name), label, entry.type->name, canopen::row_of(entry.access).name);
    switch (entry.mappable()) {
      case Mappable::no: break;
      case Mappable::tpdo: text += "  TPDO"; break;
      case Mappable::rpdo: text += "  RPDO"; break;
      case Mappable::both: text += "  PDO"; break;
    }
    return fmt::format("{}  {}:{}", padded(std::move(text), 78), file_, entry.position.line);
  }

  const Device& device_;
  const CppNames& names_;
  const Options& options_;
  std::string file_;
  IdentifierScope scope_;  ///< the names of all objects, then of elements
};

}  // namespace

ordered_json object_types_view(const NamedDevice& named, const Options& options) {
  return ObjectTypes{named, options}.view();
}

ordered_json object_rows_view(const NamedDevice& named) {
  const auto& [device, names] = named;
  ordered_json rows = ordered_json::array();
  for (const Object& object : device.objects) {
    if (!object.has_sub_indices()) {
      rows.push_back(fmt::format("od::{},", names.of(object)));
    } else if (describes_uniform_array(object)) {
      rows.push_back(fmt::format("canopen::ArrayObjects<od::{}, {}>,", names.of(object), object.entries.size() - 1));
    } else {
      for (const Entry& entry : object.entries) {
        rows.push_back(fmt::format("od::{}::{},", names.of(object), names.of(entry)));
      }
    }
  }
  if (!rows.empty()) rows.back().get_ref<std::string&>().back() = '>';
  return rows;
}

}  // namespace edsc
