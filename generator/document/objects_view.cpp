#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/access.hpp>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "backend/json/replaced_default.hpp"
#include "compare/compare_parts.hpp"
#include "device/entry_text.hpp"
#include "device/error_code_text.hpp"
#include "document/views.hpp"
#include "text/counted.hpp"
#include "values/value_bytes.hpp"
#include "values/value_text.hpp"

namespace edsc::document {
namespace {

/// An area of the object dictionary (CiA 301, 7.4.1, table 39).
struct AreaRow {
  std::uint16_t first, last;
  const char* name;
};

constexpr AreaRow area_rows[] = {
    {0x0001, 0x0FFF, "Data types"},
    {0x1000, 0x1FFF, "Communication profile"},
    {0x2000, 0x5FFF, "Manufacturer-specific profile"},
    {0x6000, 0x9FFF, "Device profile"},
    {0xA000, 0xAFFF, "Network variables"},
    {0xB000, 0xBFFF, "System variables"},
    {0xC000, 0xFFFF, "Reserved"},
};

/// The browser skips the layout of a chunk that is not visible; a page of 10,000 objects needs that.
constexpr std::size_t objects_per_chunk = 50;

/// The words of the filters for PDOs: where an entry can be mapped, and whether a default PDO maps it.
std::string mapping_words(const Entry& entry, bool is_mapped) {
  using canopen::Mappable;
  std::string words;
  if (allows(entry.mappable(), Mappable::rpdo)) words += " rpdo";
  if (allows(entry.mappable(), Mappable::tpdo)) words += " tpdo";
  if (is_mapped) words += " mapped";
  return words.empty() ? words : words.substr(1);
}

std::string mapping_text(const Entry& entry) {
  using canopen::Mappable;
  switch (entry.mappable()) {
    case Mappable::no: return "";
    case Mappable::tpdo: return "TPDO";
    case Mappable::rpdo: return "RPDO";
    case Mappable::both: return "RPDO, TPDO";
  }
  return "";
}

std::string shown_value(const std::optional<Value>& value, const canopen::DataTypeRow& type) {
  return value ? written_value(value, type) : std::string{};
}

/// The number as hexadecimal if the EDS writes it in decimal, and the reverse; empty if that says nothing new.
std::string other_base(const std::optional<Value>& value, const canopen::DataTypeRow& type) {
  if (!value || value->plus_node_id || value->bits < 10) return {};
  if (type.kind != canopen::DataClass::unsigned_integer) return {};
  return value->hexadecimal ? fmt::format("{}", value->bits) : fmt::format("0x{:X}", value->bits);
}

std::string raw_limits_text(const Entry& entry) {
  if (!entry.low_limit && !entry.high_limit) return {};
  return fmt::format("{} .. {}", shown_value(entry.low_limit, *entry.type), shown_value(entry.high_limit, *entry.type));
}

std::string unit_text_of(const Entry& entry) {
  const Quantity* const quantity = quantity_of(entry);
  return quantity == nullptr ? std::string{} : unit_text(*quantity);
}

/// The value by its meaning: `21.5 °C`, `3 profile_velocity`; empty without one.
std::string meant_text(const Device& device, const Entry& entry, const std::optional<Value>& value) {
  if (!value || value->plus_node_id) return {};
  const bool has_code = error_code_place(device, entry) != ErrorCodePlace::none;
  const bool has_meaning = entry.meaning && (quantity_of(entry) != nullptr || meaning_of_integer(entry) != nullptr);
  if (!has_code && !has_meaning) return {};
  std::optional<std::int64_t> other;
  if (entry.meaning && entry.meaning->depends_on) {
    const auto [index, sub_index] = *entry.meaning->depends_on;
    const Entry* const mode = device.find(index, sub_index);
    if (mode != nullptr && mode->default_value) other = static_cast<std::int64_t>(mode->default_value->bits);
  }
  const std::string bytes = bytes_of(*value, *entry.type);
  const std::span octets{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  std::string text, plain;
  append_device_value(text, device, entry, octets, other);
  append_value(plain, *entry.type, octets);
  const bool is_bare_word = entry.meaning && entry.meaning->has_fields() && text.find(' ') == std::string::npos;
  return text == plain || is_bare_word ? std::string{} : text;
}

/// The limits as physical values; empty without a quantity.
std::string meant_limits(const Entry& entry) {
  return quantity_of(entry) == nullptr ? std::string{} : edsc::limits_text(entry);
}

class ObjectRows {
 public:
  explicit ObjectRows(const DeviceToDocument& input)
      : input_{input}, device_{input.device()}, meanings_{input.device()} {
    for (const Pdo& pdo : device_.pdos) {
      for (const PdoEntry& mapped : pdo.entries) mapped_.emplace(mapped.index, mapped.sub_index);
    }
    if (input.compared == nullptr) return;
    for (const Change& change : input.compared->changes.all()) {
      bool& breaks = breaking_.try_emplace(change.entry.substr(0, 5), false).first->second;
      breaks = breaks || change.is_breaking();
    }
  }

  void add(Json& view) {
    Json areas = Json::array();
    for (const AreaRow& row : area_rows) {
      Json area = area_view(row);
      if (!area.is_null()) areas.push_back(std::move(area));
    }
    view["areas"] = std::move(areas);
    view["object_count"] = device_.objects.size();
    view["object_count_text"] = counted(device_.objects.size(), "object");
    view["is_configured"] = input_.loaded.sheet.is_dcf || input_.node != nullptr;
    view["types"] = types_;
    view["accesses"] = accesses_;
  }

 private:
  Json area_view(const AreaRow& row) {
    Json chunks = Json::array();
    Json objects = Json::array();
    std::size_t count = 0;
    const auto close = [&] {
      if (objects.empty()) return;
      chunks.push_back({{"size", objects.size()}, {"objects", std::exchange(objects, Json::array())}});
    };
    for (const Object& object : device_.objects) {
      if (object.index < row.first || object.index > row.last) continue;
      objects.push_back(object_view(object));
      ++count;
      if (objects.size() == objects_per_chunk) close();
    }
    close();
    if (count == 0) return nullptr;
    return {{"area", fmt::format("{:04X}", row.first)},
            {"area_name", row.name},
            {"range", fmt::format("{:04X}h to {:04X}h", row.first, row.last)},
            {"count", counted(count, "object")},
            {"chunks", std::move(chunks)}};
  }

  Json object_view(const Object& object) {
    Json entries = Json::array();
    for (const Entry& entry : object.entries) entries.push_back(entry_view(object, entry));
    const auto any = [&](auto is) { return std::ranges::any_of(object.entries, is); };
    const Entry& first = object.entries.front();
    const bool is_single = !object.has_sub_indices();
    const std::string comment = comment_before(object.position);
    const auto change = breaking_.find(index_label(object.index));
    const char* const change_class = change == breaking_.end() ? "" : change->second ? "breaking" : "compatible";
    return {{"id", index_label(object.index)},
            {"index", index_label(object.index)},
            {"name", object.name},
            {"kind", to_string(object.type)},
            {"summary_type", is_single ? std::string{first.type->name}
                                       : fmt::format("{}, {}", to_string(object.type),
                                                     counted(object.entries.size(), "entry", "entries"))},
            {"summary_access", is_single ? canopen::row_of(first.access).name : std::string_view{}},
            {"summary_mapping", is_single ? mapping_text(first) : ""},
            {"summary_value", is_single ? summary_value(first) : ""},
            {"change", shown(change_class)},
            {"denotation", shown(object.denotation)},
            {"comment", shown(comment)},
            {"links", links_of(object)},
            {"has_links", !object.links.empty()},
            {"line", line_of(object.position)},
            {"has_limits", any([](const Entry& entry) { return entry.low_limit || entry.high_limit; })},
            {"has_unit", any([](const Entry& entry) { return !unit_text_of(entry).empty(); })},
            {"has_configured", any([&](const Entry& entry) { return configured(entry).has_value(); })},
            {"entries", std::move(entries)},
            {"meanings", meanings_.of(object)}};
  }

  [[nodiscard]] std::string summary_value(const Entry& entry) const {
    std::string meant = meant_text(device_, entry, entry.default_value);
    return meant.empty() ? shown_value(entry.default_value, *entry.type) : meant;
  }

  /// The default value of an entry with another value, from the network or a DCF.
  [[nodiscard]] std::optional<ReplacedDefault> configured(const Entry& entry) const {
    if (auto set = set_by_network(entry)) return set;
    const DataSheet& sheet = input_.loaded.sheet;
    const ObjectDescription* const object = sheet.is_dcf ? sheet.find(entry.index) : nullptr;
    if (object == nullptr) return std::nullopt;
    return replaced_default(entry, sheet, *object, device_);
  }

  [[nodiscard]] std::optional<ReplacedDefault> set_by_network(const Entry& entry) const {
    if (input_.node == nullptr || input_.node->node.settings.find(entry.index, entry.sub_index) == nullptr) {
      return std::nullopt;
    }
    return ReplacedDefault{input_.loaded.device->find(entry.index, entry.sub_index)->default_value};
  }

  Json entry_view(const Object& object, const Entry& entry) {
    const auto configured_entry = configured(entry);
    const std::optional<Value>& standard = configured_entry ? configured_entry->default_value : entry.default_value;
    const bool is_changed = configured_entry && !same_value(standard, entry.default_value);
    const std::string_view access = canopen::row_of(entry.access).name;
    types_.emplace(entry.type->name);
    accesses_.emplace(access);
    const std::string comment = object.has_sub_indices() ? comment_before(entry.position) : "";
    const CppType cpp = input_.loaded.names->type_of(object, entry);
    return {
        {"sub_id", object.has_sub_indices() ? Json(anchor_of(object, entry)) : Json(nullptr)},
        {"href", anchor_of(object, entry)},
        {"sub_index", fmt::format("{:02X}", entry.sub_index)},
        {"entry_name", entry.name},
        {"type", entry.type->name},
        {"octets", entry.octets == 0 ? Json(nullptr) : Json(entry.octets)},
        {"access", access},
        {"mapping", mapping_text(entry)},
        {"mapping_words", shown(mapping_words(entry, mapped_.contains({entry.index, entry.sub_index})))},
        {"default", shown_value(standard, *entry.type)},
        {"default_meant", shown(meant_text(device_, entry, standard))},
        {"other_base", shown(other_base(standard, *entry.type))},
        {"clause", standard ? shown(standard->clause) : Json(nullptr)},
        {"configured", configured_entry ? Json(shown_value(entry.default_value, *entry.type)) : Json(nullptr)},
        {"configured_meant", configured_entry ? shown(meant_text(device_, entry, entry.default_value)) : Json(nullptr)},
        {"changed", is_changed},
        {"limits", raw_limits_text(entry)},
        {"limits_meant", shown(meant_limits(entry))},
        {"unit", unit_text_of(entry)},
        {"cpp", cpp.text()},
        {"cpp_object", cpp.object},
        {"cpp_member", shown(cpp.member)},
        {"entry_line", line_of(entry.position)},
        {"description", shown(entry.description)},
        {"entry_comment", shown(comment)}};
  }

  [[nodiscard]] Json links_of(const Object& object) const {
    Json links = Json::array();
    for (const std::uint16_t index : object.links) links.push_back({{"link", index_label(index)}});
    return links;
  }

  const DeviceToDocument& input_;
  const Device& device_;
  MeaningTables meanings_;
  std::set<std::pair<std::uint16_t, std::uint8_t>> mapped_;  ///< by default PDOs
  std::map<std::string, bool> breaking_;  ///< `6041h` of changed objects, and whether a change breaks anything
  std::set<std::string> types_, accesses_;
};

}  // namespace

void add_objects(const DeviceToDocument& device, Json& view) { ObjectRows{device}.add(view); }

}  // namespace edsc::document
