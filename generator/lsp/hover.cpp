#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>

#include "device/cob_id_parameter.hpp"
#include "device/entry_text.hpp"
#include "device/meaning/profiles.hpp"
#include "device/objects/standard_objects.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "lookup/find_entry.hpp"
#include "lsp/features.hpp"
#include "lsp/network_place.hpp"
#include "lsp/options_place.hpp"
#include "lsp/sheet_place.hpp"
#include "text/markdown.hpp"

namespace edsc::lsp {
namespace {

/// `CiA 301, 7.5.2.1`, or the profile with the title of its document.
std::string source_of(const Device& device, std::uint16_t index) {
  if (const StandardObject* const standard = find_standard_object(index)) {
    return fmt::format("CiA 301, {}: {}", standard->clause, standard->name);
  }
  const Entry* const type = device.find(0x1000, 0);
  if (type == nullptr || !type->default_value || index < 0x6000) return {};
  const MeaningProfile* const profile = find_profile(static_cast<std::uint16_t>(type->default_value->bits & 0xFFFF));
  if (profile == nullptr || profile->find(profile->place_of(index).index) == nullptr) return {};
  return profile->title;
}

std::string_view mappable_text(canopen::Mappable mappable) {
  switch (mappable) {
    case canopen::Mappable::no: return "not PDO-mappable";
    case canopen::Mappable::tpdo: return "TPDO-mappable";
    case canopen::Mappable::rpdo: return "RPDO-mappable";
    case canopen::Mappable::both: return "PDO-mappable";
  }
  return "";
}

std::string bits_text(const PlacedObject& mapped) {
  if (mapped.offset % 8 != 0 || mapped.bits % 8 != 0) {
    return mapped.bits == 1 ? fmt::format("bit {}", mapped.offset)
                            : fmt::format("bits {}..{}", mapped.offset, mapped.end() - 1);
  }
  const unsigned first = mapped.offset / 8u;
  const unsigned last = mapped.end() / 8 - 1;
  return first == last ? fmt::format("byte {}", first) : fmt::format("bytes {}..{}", first, last);
}

/// `185h, valid, 11 bits`
std::string cob_id_text(const Value& value) {
  const canopen::CobId cob_id{static_cast<std::uint32_t>(value.bits)};
  return fmt::format("CAN-ID {:03X}h{}, {}, {} bits", cob_id.can_id(), value.plus_node_id ? " + node-ID" : "",
                     cob_id.valid() ? "valid" : "not valid (bit 31)", cob_id.extended() ? 29 : 11);
}

std::string mapped_by(const Device& device, const Entry& entry) {
  std::string text;
  for (const Pdo& pdo : device.pdos) {
    for (const PdoEntry& mapped : pdo.entries) {
      if (mapped.index != entry.index || mapped.sub_index != entry.sub_index) continue;
      text += fmt::format("{}{}, {}", text.empty() ? "Mapped by " : "; ", pdo_label(pdo), bits_text(mapped));
    }
  }
  return text;
}

/// A line of Markdown of its own.
void add_line(std::string& text, std::string_view line) {
  if (!line.empty()) text += fmt::format("  \n{}", line);
}

void describe_entry(const LoadedDevice& loaded, const Device& device, const Object& object, const Entry& entry,
                    std::string& text) {
  if (entry.type != nullptr) {
    add_line(text, fmt::format("{}, {}, {}", entry.type->name, canopen::row_of(entry.access).name,
                               mappable_text(entry.mappable())));
    if (entry.default_value) {
      add_line(text, fmt::format("Default value: `{}`", written_value(entry.default_value, *entry.type)));
    }
  }
  if (const std::string limits = limits_text(entry); !limits.empty()) add_line(text, "Limits: " + limits);
  if (entry.default_value && find_cob_id_parameter(entry.index, entry.sub_index) != nullptr) {
    add_line(text, cob_id_text(*entry.default_value));
  }
  add_line(text, mapped_by(device, entry));
  if (loaded.names) add_line(text, fmt::format("C++: `{}`", loaded.names->type_of(object, entry).text()));
  if (entry.meaning) {
    if (!entry.meaning->text.empty()) text += "\n\n" + markdown_text(entry.meaning->text);
    if (entry.meaning->values) {
      for (const NamedValue& value : entry.meaning->values->values) {
        text += fmt::format("\n- {}: `{}`", value.value, value.name);
      }
    }
    for (const BitField& field : entry.meaning->fields) {
      if (field.is_reserved()) continue;
      text += field.bits == 1
                  ? fmt::format("\n- bit {}: `{}`", field.first_bit, field.name)
                  : fmt::format("\n- bits {}..{}: `{}`", field.first_bit, field.first_bit + field.bits - 1, field.name);
    }
  }
}

Json markdown_hover(std::string text) {
  if (text.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", std::move(text)}}}};
}

/// What a mapping value says: `0x60410010`: 16 bits of 6041h:00 at byte 0.
std::string describe_mapping(const Device& device, const SheetPlace& place) {
  const auto mapped = mapping_at(place.name, *place.entry);
  const auto address = address_of_value(place.name, *place.entry);
  if (!mapped || !address) return {};
  std::string text = fmt::format("`{}`: {} bits of {}", current_value(*place.entry), unsigned{mapped->bits},
                                 entry_label(mapped->index, mapped->sub_index));
  for (const Pdo& pdo : device.pdos) {
    if (pdo.mapping == nullptr || pdo.mapping->index != address->index) continue;
    for (const PdoEntry& one : pdo.entries) {
      if (one.position == *address->sub_index) text += fmt::format(", {} of {}", bits_text(one), pdo_label(pdo));
    }
  }
  return text + "\n\n";
}

}  // namespace

std::string describe(const LoadedDevice& loaded, const Device& device, const EntryAddress& address) {
  const Object* const object = device.find(address.index);
  if (object == nullptr) return {};
  const Entry* const entry = address.sub_index ? device.find(address.index, *address.sub_index)
                             : !object->has_sub_indices() && !object->entries.empty() ? &object->entries.front()
                                                                                      : nullptr;
  std::string text = fmt::format(
      "**{} {}**", entry != nullptr ? entry_label(entry->index, entry->sub_index) : index_label(object->index),
      markdown_text(entry != nullptr && object->has_sub_indices() ? object->name + ", " + entry->name : object->name));
  add_line(text, source_of(device, object->index));
  if (entry != nullptr) {
    describe_entry(loaded, device, *object, *entry, text);
  } else {
    add_line(text, fmt::format("{} of {} entries", to_string(object->type), object->entries.size()));
  }
  return text;
}

Json hover(const View& view, const TextPosition& at) {
  if (view.document.kind == DocumentKind::network) return markdown_hover(describe_network_place(view, at));
  if (view.has_options()) return markdown_hover(describe_options_place(view, at));
  const Device* const device = view.analysis.device();
  if (!view.is_sheet() || device == nullptr) return nullptr;
  const SheetPlace place = place_in(view.analysis.ini, at.line + 1, view.column_of(at));
  const auto target = target_of(place);
  if (!target) return nullptr;
  std::string text = place.entry != nullptr && place.is_in_value ? describe_mapping(*device, place) : std::string{};
  return markdown_hover(text + describe(*view.analysis.loaded, *device, *target));
}

Json inlay_hints(const View& view, const TextRange& range) {
  Json hints = Json::array();
  const Device* const device = view.analysis.device();
  if (!view.is_sheet()) return hints;
  const auto add = [&](const IniEntry& entry, const std::string& label) {
    const auto end = entry.value_column + static_cast<std::uint32_t>(entry.value.size());
    const TextRange at = range_in(*view.analysis.own, entry.line, end, 0, view.encoding);
    hints.push_back({{"position", to_json(at.start)}, {"label", label}, {"paddingLeft", true}});
  };
  const auto mapping_hint = [&](const SectionName& name, const IniEntry& entry) -> std::string {
    const auto mapped = mapping_at(name, entry);
    const auto address = address_of_value(name, entry);
    if (!mapped || device == nullptr) return {};
    const Entry* const object = device->find(mapped->index, mapped->sub_index);
    std::string label = "= ";
    label += object != nullptr    ? object->name
             : mapped->is_dummy() ? "dummy"
                                  : entry_label(mapped->index, mapped->sub_index) + " (missing)";
    for (const Pdo& pdo : device->pdos) {
      if (pdo.mapping == nullptr || pdo.mapping->index != address->index) continue;
      for (const PdoEntry& one : pdo.entries) {
        if (one.position == *address->sub_index) label += ", " + bits_text(one);
      }
    }
    return label;
  };
  const auto formula_hint = [&](const IniEntry& entry) -> std::string {
    const std::string_view value = current_value(entry);
    if (value.find('$') == std::string_view::npos) return {};
    const Formula formula = split_formula(value);
    const auto constant = formula.constant ? parse_unsigned(*formula.constant) : std::optional<std::uint64_t>{0};
    if (!equal_ignoring_case(formula.variable, "$NODEID") || !constant) return {};
    if (device != nullptr && device->node_id) return fmt::format("= {:X}h", *constant + *device->node_id);
    return fmt::format("= {:X}h..{:X}h", *constant + 1, *constant + 127);
  };
  const IniFile& ini = view.analysis.ini;
  for (const IniSection& section : ini.sections) {
    if (section.line > range.end.line + 1) break;
    if (section.entries.empty() || section.entries.back().line < range.start.line + 1) continue;
    const SectionName name = read_section_name(section.name, ini.source->choices().sub_indices);
    for (const IniEntry& entry : section.entries) {
      if (entry.line < range.start.line + 1 || entry.line > range.end.line + 1) continue;
      std::string label = mapping_hint(name, entry);
      if (label.empty()) label = formula_hint(entry);
      if (!label.empty()) add(entry, label);
    }
  }
  return hints;
}

}  // namespace edsc::lsp
