#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "lsp/features.hpp"
#include "lsp/network_place.hpp"
#include "lsp/options_place.hpp"
#include "lsp/sheet_place.hpp"
#include "overlay/overlay_keys.hpp"

namespace edsc::lsp {
namespace {

enum ItemKinds { field_item = 5, value_item = 12, section_item = 9 };

class SheetCompletion {
 public:
  SheetCompletion(const View& view, const TextPosition& at)
      : view_{view},
        at_{at},
        line_{view.line(at.line + 1)},
        column_{view.column_of(at)},
        before_{line_.substr(0, column_ - 1)},
        place_{place_in(view.analysis.ini, at.line + 1, column_)} {}

  Json run() {
    const std::size_t text = before_.find_first_not_of(" \t");
    if (text != std::string_view::npos && (before_[text] == ';' || before_[text] == '#')) return std::move(items_);
    if (text != std::string_view::npos && before_[text] == '[') {
      begin_ = text + 1;
      offer_sections();
      return std::move(items_);
    }
    const std::size_t equals = before_.find('=');
    if (equals == std::string_view::npos) {
      begin_ = std::min(text, before_.size());
      offer_keys();
    } else {
      const std::size_t arrow_at = before_.find(arrow, equals);
      const std::size_t value = arrow_at == std::string_view::npos ? equals + 1 : arrow_at + arrow.size();
      begin_ = std::min(before_.find_first_not_of(' ', value), before_.size());
      offer_values(before_.substr(0, equals));
    }
    return std::move(items_);
  }

 private:
  void add(int kind, const std::string& label, const std::string& text, const std::string& detail = {}) {
    const TextRange range = range_in(*view_.analysis.own, at_.line + 1, static_cast<std::uint32_t>(begin_) + 1,
                                     before_.size() - begin_, view_.encoding);
    items_.push_back({{"label", label},
                      {"kind", kind},
                      {"detail", detail},
                      {"filterText", label == text ? label : text + " " + label},
                      {"textEdit", {{"range", to_json(range)}, {"newText", text}}}});
  }

  [[nodiscard]] bool has_section(std::string_view name) const {
    return std::ranges::any_of(view_.analysis.ini.sections,
                               [&](const IniSection& one) { return equal_ignoring_case(one.name, name); });
  }

  void offer_sections() {
    const std::string_view end = line_.substr(before_.size()).starts_with(']') ? "" : "]";
    const auto offer = [&](const std::string& name, const std::string& detail) {
      if (!has_section(name)) add(section_item, name, name + std::string{end}, detail);
    };
    if (view_.document.kind == DocumentKind::overlay) offer(std::string{overlay_section}, "");
    for (const SectionRow& row : section_rows) {
      if (row.form == NameForm::title) offer(std::string{row.title}, "");
    }
    if (view_.analysis.loaded == nullptr) return;
    for (const ListedObject& listed : view_.analysis.loaded->sheet.listed) {
      offer(fmt::format("{:04X}", listed.index), "listed object");
    }
    for (const ObjectDescription& object : view_.analysis.loaded->sheet.objects) {
      if (object.sub_number.empty() && object.sub_objects.empty()) continue;
      unsigned next = 0;
      for (const SubObjectDescription& sub : object.sub_objects) next = std::max(next, sub.sub_index + 1U);
      offer(fmt::format("{:04X}sub{:X}", object.index, next), std::string{object.parameter_name.text});
    }
  }

  void offer_keys() {
    if (place_.section == nullptr) return;
    const auto has = [&](std::string_view key) {
      const IniEntry* const found = place_.section->find(key);
      return found != nullptr && found->line != at_.line + 1;
    };
    const std::string end = line_.find('=') == std::string_view::npos ? "=" : "";
    const auto offer = [&](std::string_view key) {
      if (!has(key)) add(field_item, std::string{key}, std::string{key} + end);
    };
    if (equal_ignoring_case(place_.section->name, overlay_section)) {
      for (const auto& row : overlay_keys) offer(row.key.name);
      return;
    }
    if (view_.document.kind == DocumentKind::overlay) {
      for (const std::string_view key : {remove_key, rename_key, count_key}) offer(key);
    }
    const SectionRow* row = find_section(place_.name.kind);
    if (row == nullptr && view_.document.kind == DocumentKind::overlay) row = find_section(SectionKind::sub_object);
    if (row == nullptr) return;
    for (const SectionKey& key : row->keys) {
      if (key.value == ValueKind::count || !key.is_numbered()) {
        offer(key.name);
      } else if (place_.name.kind == SectionKind::device_info) {
        for (const unsigned rate : {10, 20, 50, 125, 250, 500, 800, 1000}) offer(spell_numbered_key(key, rate));
      } else {
        std::uint32_t next = 1;
        for (const IniEntry& entry : place_.section->entries) {
          if (const auto number = match_key(key, entry.key); number && entry.line != at_.line + 1) {
            next = std::max(next, *number + 1);
          }
        }
        if (next <= key.last_number) offer(spell_numbered_key(key, next));
      }
    }
  }

  void offer_values(std::string_view key) {
    key = key.substr(std::min(key.find_first_not_of(" \t"), key.size()));
    const auto is = [&](std::string_view name) { return equal_ignoring_case(key, name); };
    if (is("AccessType")) {
      for (const canopen::AccessRow& row : canopen::access_rows)
        add(value_item, std::string{row.name}, std::string{row.name});
    } else if (is("DataType")) {
      for (const canopen::DataTypeRow& row : canopen::data_types) {
        add(value_item, std::string{row.name}, fmt::format("0x{:04X}", static_cast<unsigned>(row.type)));
      }
    } else if (is("ObjectType")) {
      for (const ObjectType type : {ObjectType::var, ObjectType::array, ObjectType::record, ObjectType::domain,
                                    ObjectType::deftype, ObjectType::defstruct}) {
        add(value_item, std::string{to_string(type)}, fmt::format("0x{:X}", static_cast<unsigned>(type)));
      }
    } else if (is("PDOMapping") || is("LSS_Supported") || is("SimpleBootUpMaster") || is("SimpleBootUpSlave") ||
               is("GroupMessaging") || is("DynamicChannelsSupported") || is("CANopenManager") ||
               starts_with_ignoring_case(key, "BaudRate_") || is(remove_key)) {
      for (const char* const value : {"0", "1"}) add(value_item, value, value);
    } else if (is_object_list(place_.name.kind)) {
      offer_unlisted();
    } else if (is("DefaultValue") || is("ParameterValue") || place_.name.kind == SectionKind::compact_values) {
      offer_default_values();
    }
  }

  /// Objects that are described but not listed.
  void offer_unlisted() {
    if (view_.analysis.loaded == nullptr) return;
    const DataSheet& sheet = view_.analysis.loaded->sheet;
    std::set<std::uint16_t> listed;
    for (const ListedObject& one : sheet.listed) listed.insert(one.index);
    for (const ObjectDescription& object : sheet.objects) {
      if (listed.contains(object.index)) continue;
      const std::string text = fmt::format("0x{:04X}", object.index);
      add(value_item, text, text, std::string{object.parameter_name.text});
    }
  }

  void offer_default_values() {
    const Device* const device = view_.analysis.device();
    if (device == nullptr || place_.section == nullptr) return;
    const std::uint16_t index = place_.name.index;
    const std::uint8_t sub_index = place_.name.sub_index;
    if (contains(mapping_parameters, index)) return offer_mappable(*device, index < 0x1A00);
    const auto* const parameter = find_cob_id_parameter(index, sub_index);
    if (parameter != nullptr) {
      const std::uint32_t value = parameter->predefined_of(index);
      const std::string text =
          parameter->plus_node_id ? fmt::format("$NODEID+0x{:X}", value) : fmt::format("0x{:X}", value);
      add(value_item, text, text, fmt::format("CiA 301, {}", parameter->clause));
    }
    const Entry* const entry = device->find(index, sub_index);
    if (entry == nullptr || !entry->meaning || !entry->meaning->values) return;
    for (const NamedValue& value : entry->meaning->values->values) {
      add(value_item, value.name, fmt::format("{}", value.value), fmt::format("{}", value.value));
    }
  }

  void offer_mappable(const Device& device, bool is_rpdo) {
    const auto direction = is_rpdo ? canopen::Mappable::rpdo : canopen::Mappable::tpdo;
    for (const Object& object : device.objects) {
      for (const Entry& entry : object.entries) {
        if (!canopen::allows(entry.mappable(), direction) || entry.type == nullptr || entry.type->bits == 0) continue;
        const MappingValue mapped{entry.index, entry.sub_index, entry.type->bits};
        const std::string name = object.has_sub_indices() ? object.name + ", " + entry.name : entry.name;
        add(value_item, name, fmt::format("0x{:08X}", mapped.value()),
            fmt::format("{}, {} bits", entry_label(entry.index, entry.sub_index), entry.type->bits));
      }
    }
  }

  const View& view_;
  const TextPosition& at_;
  std::string_view line_;
  std::uint32_t column_;
  std::string_view before_;
  SheetPlace place_;
  std::size_t begin_ = 0;  ///< of the word, in the line
  Json items_ = Json::array();
};

}  // namespace

Json completion(const View& view, const TextPosition& at) {
  if (view.document.kind == DocumentKind::network) return network_completion(view, at);
  if (view.has_options()) return options_completion(view, at);
  return view.is_sheet() ? SheetCompletion{view, at}.run() : Json::array();
}

}  // namespace edsc::lsp
