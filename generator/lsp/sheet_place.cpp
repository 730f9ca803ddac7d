#include "lsp/sheet_place.hpp"

#include <algorithm>
#include <limits>

#include "device/index_range.hpp"
#include "eds/number.hpp"
#include "overlay/overlay_keys.hpp"

namespace edsc::lsp {

SheetPlace place_in(const IniFile& ini, std::uint32_t line, std::uint32_t column) {
  const auto next = std::ranges::upper_bound(ini.sections, line, {}, &IniSection::line);
  if (next == ini.sections.begin()) return {};
  const IniSection& section = *std::prev(next);
  const SubIndexNotation notation =
      ini.source != nullptr ? ini.source->choices().sub_indices : SubIndexNotation::hexadecimal;
  SheetPlace place{&section, read_section_name(section.name, notation)};
  const auto entry = std::ranges::lower_bound(section.entries, line, {}, &IniEntry::line);
  if (entry == section.entries.end() || entry->line != line) return place;
  place.entry = &*entry;
  place.is_in_value = column > entry->key_column + entry->key.size();
  return place;
}

std::string_view current_value(const IniEntry& entry) {
  std::string_view value = entry.value;
  if (const std::size_t at = value.find(arrow); at != std::string_view::npos) {
    value.remove_prefix(at + arrow.size());
    value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  }
  return strip_inline_comment(value);
}

std::optional<EntryAddress> address_of_value(const SectionName& name, const IniEntry& entry) {
  if (name.kind == SectionKind::compact_values) {
    const auto sub_index = parse_unsigned(entry.key);
    if (!sub_index || *sub_index > 0xFF) return std::nullopt;
    return EntryAddress{name.index, static_cast<std::uint8_t>(*sub_index)};
  }
  const bool is_value =
      equal_ignoring_case(entry.key, "DefaultValue") || equal_ignoring_case(entry.key, "ParameterValue");
  if (!is_value || (name.kind != SectionKind::object && name.kind != SectionKind::sub_object)) return std::nullopt;
  return EntryAddress{name.index, name.kind == SectionKind::sub_object ? name.sub_index : std::uint8_t{0}};
}

std::optional<MappingValue> mapping_at(const SectionName& name, const IniEntry& entry) {
  const auto address = address_of_value(name, entry);
  if (!address || !contains(mapping_parameters, address->index) || address->sub_index == 0) return std::nullopt;
  const auto number = parse_unsigned(current_value(entry));
  if (!number || *number == 0 || *number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return MappingValue::of(static_cast<std::uint32_t>(*number));
}

std::optional<std::uint16_t> listed_index(const SectionName& name, const IniEntry& entry) {
  if (!is_object_list(name.kind) && name.kind != SectionKind::object_links) return std::nullopt;
  const auto index = parse_unsigned(current_value(entry));
  if (!parse_unsigned(entry.key) || !index || *index > 0xFFFF) return std::nullopt;
  return static_cast<std::uint16_t>(*index);
}

std::optional<EntryAddress> target_of(const SheetPlace& place) {
  if (place.section == nullptr) return std::nullopt;
  if (place.entry != nullptr) {
    if (const auto index = listed_index(place.name, *place.entry)) return EntryAddress{*index, {}};
    const auto mapped = place.is_in_value ? mapping_at(place.name, *place.entry) : std::nullopt;
    if (mapped) return EntryAddress{mapped->index, mapped->sub_index};
    if (place.name.kind == SectionKind::compact_values) return address_of_value(place.name, *place.entry);
  }
  if (!is_object_section(place.name.kind)) return std::nullopt;
  if (place.name.kind == SectionKind::sub_object) return EntryAddress{place.name.index, place.name.sub_index};
  return EntryAddress{place.name.index, {}};
}

}  // namespace edsc::lsp
