#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/cpp/meaning_comment.hpp"
#include "device/drive_modes.hpp"
#include "device/uniform_array.hpp"
#include "diagnostics/place.hpp"
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

class ObjectTypes {
 public:
  ObjectTypes(const NamedDevice& named, const TypedValues& typed, const Options& options)
      : device_{named.device}, names_{named.names}, typed_{typed}, options_{options} {
    file_ = cpp_comment(file_name_of(device_.source->name()));
  }

  [[nodiscard]] ordered_json view() const {
    ordered_json rows = json_array(device_.objects.size());
    for (const Object& object : device_.objects) rows.push_back(object_row(object));
    return rows;
  }

 private:
  [[nodiscard]] ordered_json object_row(const Object& object) const {
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

  [[nodiscard]] ordered_json array_row(const Object& object) const {
    const Entry& first = object.entries[1];
    const std::size_t length = object.entries.size() - 1;
    const std::string label = fmt::format("{}:01..{:02X}", index_label(object.index), length);
    ordered_json count = entry_row(object.entries.front());
    count["array_identifier"] = names_.of(object);
    const std::string identifier = names_.of(object);
    const TypedValue* const typed = typed_.is_uniform(object) ? typed_.find(first) : nullptr;
    return json_object("comment", comment(first, object.name, label), "meaning_lines",
                       typed_.is_uniform(object) ? lines_of(first) : ordered_json::array(), "identifier", identifier,
                       "name", cpp_string(object.name), "base",
                       fmt::format("canopen::Object<{}, SubIndex, {}>", index_of(first), attributes(first)), "typed",
                       typed_row(typed, identifier), "constants",
                       constants(first, typed, fmt::format("typename {}::type", identifier)), "length", length, "count",
                       std::move(count), "typed_elements", typed_elements(object), "elements", element_names(object));
  }

  /// Elements that have another type than others: specializations of the template, whose values are raw numbers.
  [[nodiscard]] ordered_json typed_elements(const Object& object) const {
    ordered_json rows = ordered_json::array();
    if (typed_.is_uniform(object)) return rows;
    for (std::size_t i = 1; i < object.entries.size(); ++i) {
      const Entry& entry = object.entries[i];
      const TypedValue* const typed = typed_.find(entry);
      if (typed == nullptr) continue;
      rows.push_back(
          json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)), "meaning_lines",
                      lines_of(entry), "array_identifier", names_.of(object), "number", entry.sub_index, "name",
                      cpp_string(object.name), "base",
                      fmt::format("canopen::Object<{}, {}, {}>", index_of(entry), entry.sub_index, attributes(entry)),
                      "typed", typed_row(typed, names_.of(object)), "constants", constants(entry, typed, "type")));
    }
    return rows;
  }

  /// What the values of an entry mean, as lines of its comment.
  [[nodiscard]] ordered_json lines_of(const Entry& entry) const {
    return options_.typed_values ? meaning_lines(entry) : ordered_json::array();
  }

  /// The type of values with a meaning; null for raw numbers.
  [[nodiscard]] static ordered_json typed_row(const TypedValue* typed, std::string_view identifier) {
    if (typed == nullptr) return nullptr;
    ordered_json closed = nullptr;
    if (typed->is_closed()) closed = json_object("enumerators", typed->enumerators);
    // A member cannot have the name of its class.
    const bool has_alias = typed->values != nullptr && identifier != "value";
    return json_object("type", typed->type, "value", has_alias, "closed", std::move(closed));
  }

  /// Elements that have their own name, such as `gains_p` for `gains<1>`; null if there are none.
  [[nodiscard]] ordered_json element_names(const Object& object) const {
    ordered_json rows = ordered_json::array();
    for (const Entry& entry : object.entries) {
      const std::string* const name = names_.identifiers().element(entry);
      if (name == nullptr) continue;
      rows.push_back(json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)),
                                 "identifier", without_reserved_word(*name), "number", entry.sub_index));
    }
    if (rows.empty()) return nullptr;
    return json_object("array", names_.of(object), "rows", std::move(rows));
  }

  [[nodiscard]] ordered_json entry_row(const Entry& entry) const {
    const TypedValue* const typed = typed_.find(entry);
    std::string identifier = names_.of(entry);
    ordered_json type = typed_row(typed, identifier);
    return json_object("comment", comment(entry, entry.name, entry_label(entry.index, entry.sub_index)),
                       "meaning_lines", lines_of(entry), "identifier", std::move(identifier), "name",
                       cpp_string(entry.name), "base", fmt::format("canopen::TypedObject<{}>", attributes(entry)),
                       "typed", std::move(type), "index", index_of(entry), "sub_index",
                       fmt::format("0x{:02X}", entry.sub_index), "constants", constants(entry, typed, "type"),
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

  /// Limits. Those of a quantity are quantities; those of enumerations and words are raw numbers.
  [[nodiscard]] static ordered_json constants(const Entry& entry, const TypedValue* typed, std::string_view type) {
    ordered_json rows = ordered_json::array();
    const auto add = [&](const char* name, const std::optional<Value>& value) {
      if (!value || value->plus_node_id) return;
      std::string literal = cpp_literal(*value, *entry.type);
      if (typed == nullptr) {
        rows.push_back(json_object("type", type, "name", name, "value", " = " + literal));
      } else if (typed->is_quantity) {
        literal = fmt::format("{{canopen::raw({}{{{}}})}}", entry.type->cpp_type, literal);
        rows.push_back(json_object("type", type, "name", name, "value", std::move(literal)));
      } else {
        rows.push_back(json_object("type", entry.type->cpp_type, "name", name, "value", " = " + literal));
      }
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
    const Position place = origin_of(entry.position);
    const std::string file = place.file == entry.position.file ? file_ : cpp_comment(file_name_of(place.file->name()));
    return fmt::format("{}  {}:{}", padded(std::move(text), 78), file, place.line);
  }

  const Device& device_;
  const CppNames& names_;
  const TypedValues& typed_;
  const Options& options_;
  std::string file_;
};

}  // namespace

ordered_json object_types_view(const NamedDevice& named, const TypedValues& typed, const Options& options) {
  return ObjectTypes{named, typed, options}.view();
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
