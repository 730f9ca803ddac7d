#include "change/new_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include "device/meaning/profiles.hpp"
#include "device/objects/standard_objects.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// Default values of CiA 301, 7.5.2, and of the pre-defined connection set; sub-index 0 of a VAR.
struct StandardDefault {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::string_view value;
};
constexpr StandardDefault standard_defaults[] = {
    {0x1005, 0, "0x00000080"},
    {0x1010, 1, "1"},
    {0x1011, 1, "1"},
    {0x1012, 0, "0x00000100"},
    {0x1014, 0, "$NODEID+0x80"},
    {0x1018, 1, "0"},
    {0x1200, 1, "$NODEID+0x600"},
    {0x1200, 2, "$NODEID+0x580"},
    {0x1016, 1, "0"},
    {0x1029, 1, "0"},
};

/// Names of sub-indices of CiA 301.
struct StandardEntryName {
  std::uint16_t first, last;
  std::uint8_t sub_index;
  std::string_view name;
};
constexpr StandardEntryName standard_entry_names[] = {
    {0x1010, 0x1010, 1, "Save all parameters"},
    {0x1011, 0x1011, 1, "Restore all default parameters"},
    {0x1018, 0x1018, 1, "Vendor-ID"},
    {0x1018, 0x1018, 2, "Product code"},
    {0x1018, 0x1018, 3, "Revision number"},
    {0x1018, 0x1018, 4, "Serial number"},
    {0x1020, 0x1020, 1, "Configuration date"},
    {0x1020, 0x1020, 2, "Configuration time"},
    {0x1029, 0x1029, 1, "Communication error"},
    {0x1200, 0x127F, 1, "COB-ID client to server"},
    {0x1200, 0x127F, 2, "COB-ID server to client"},
    {0x1200, 0x127F, 3, "Node-ID of the SDO client"},
    {0x1280, 0x12FF, 1, "COB-ID client to server"},
    {0x1280, 0x12FF, 2, "COB-ID server to client"},
    {0x1280, 0x12FF, 3, "Node-ID of the SDO server"},
    {0x1400, 0x15FF, 1, "COB-ID used by RPDO"},
    {0x1400, 0x15FF, 2, "Transmission type"},
    {0x1800, 0x19FF, 1, "COB-ID used by TPDO"},
    {0x1800, 0x19FF, 2, "Transmission type"},
    {0x1800, 0x19FF, 3, "Inhibit time"},
    {0x1800, 0x19FF, 5, "Event timer"},
};

/// Parameters with a COB-ID in sub-index 1, or in 1 and 2. `per_node`: that of the pre-defined connection set for the
/// first `predefined` of them; others are disabled.
struct CobIdParameters {
  std::uint16_t first, last;
  std::uint8_t last_sub_index;
  std::uint16_t predefined;
  std::uint16_t per_node;
};
constexpr std::uint16_t cob_id_step = 0x100;  ///< from a PDO to the next one
constexpr CobIdParameters cob_id_parameters[] = {
    {0x1201, 0x12FF, 2, 0, 0},
    {0x1400, 0x15FF, 1, 4, 0x200},
    {0x1800, 0x19FF, 1, 4, 0x180},
};
constexpr std::string_view disabled_cob_id = "0x80000000";

std::string default_of(std::uint16_t index, std::uint8_t sub_index, const canopen::DataTypeRow& type) {
  for (const StandardDefault& row : standard_defaults) {
    if (row.index == index && row.sub_index == sub_index) return std::string{row.value};
  }
  for (const CobIdParameters& row : cob_id_parameters) {
    if (index < row.first || index > row.last || sub_index == 0 || sub_index > row.last_sub_index) continue;
    const auto number = static_cast<std::uint16_t>(index - row.first);
    if (number >= row.predefined) return std::string{disabled_cob_id};
    return fmt::format("$NODEID+0x{:X}", row.per_node + number * cob_id_step);
  }
  return type.bits == 0 ? "" : "0";
}

std::string entry_name(std::uint16_t index, std::uint8_t sub_index, std::string_view object) {
  for (const StandardEntryName& row : standard_entry_names) {
    if (index >= row.first && index <= row.last && row.sub_index == sub_index) return std::string{row.name};
  }
  return fmt::format("{} {}", object, sub_index);
}

std::string capitalized(std::string_view text) {
  std::string result{text};
  if (!result.empty()) result.front() = to_upper(result.front());
  return result;
}

std::string_view access_text(canopen::Access access) {
  const auto* const row = std::ranges::find(canopen::access_rows, access, &canopen::AccessRow::access);
  return row->name;
}

NewValue standard_value(const StandardEntry& entry, std::uint16_t index, std::uint8_t sub_index, std::string name) {
  const canopen::DataTypeRow& type = *canopen::find_data_type(static_cast<std::uint32_t>(entry.type));
  NewValue value{std::move(name), &type, std::string{access_text(entry.access.assumed())}};
  value.default_value = default_of(index, sub_index, type);
  value.sub_index = sub_index;
  return value;
}

/// Of an SDO server parameter the node-ID of its client, and of a PDO parameter what it does not have, or few devices
/// do.
bool is_left_out(const StandardObject& object, const StandardEntry& entry, std::uint16_t index) {
  if (object.type != ObjectType::record || entry.required) return false;
  if (index >= 0x1200 && index <= 0x127F) return true;
  const bool is_receive = index >= 0x1400 && index <= 0x15FF;
  const bool is_transmit = index >= 0x1800 && index <= 0x19FF;
  constexpr std::uint8_t inhibit_time = 3, event_timer = 5;
  return (is_receive || is_transmit) && !(is_transmit && (entry.first == inhibit_time || entry.first == event_timer));
}

bool is_mapping_parameter(const StandardObject& object) {
  return object.entries.data() == std::data(standard::pdo_mapping);
}

/// Whether the user states the number of entries: elements of an ARRAY, entries of a mapping.
bool is_list(const StandardObject& object, const StandardEntry& entry) {
  return (object.type == ObjectType::array || is_mapping_parameter(object)) && entry.last > entry.first;
}

std::optional<NewObject> object_of_cia301(std::uint16_t index, std::uint8_t elements) {
  const StandardObject* const row = find_standard_object(index);
  if (row == nullptr) return std::nullopt;
  NewObject object{index, row->type, capitalized(row->name), {}};
  if (row->type == ObjectType::var) {
    object.values.push_back(standard_value(row->entries.front(), index, 0, object.name));
    return object;
  }
  object.has_writable_count = index == 0x1003 || is_mapping_parameter(*row);
  for (const StandardEntry& entry : row->entries) {
    if (is_left_out(*row, entry, index)) continue;
    const unsigned last = is_list(*row, entry) ? entry.first + elements - 1U : entry.last;
    for (unsigned sub = entry.first; sub <= std::min<unsigned>(last, entry.last); ++sub) {
      const auto sub_index = static_cast<std::uint8_t>(sub);
      object.values.push_back(standard_value(entry, index, sub_index, entry_name(index, sub_index, object.name)));
    }
  }
  return object;
}

/// A value of an object of a profile; the entry may have a type and an access type of its own.
NewValue profile_value(const ProfileObject& row, const ProfileEntry& entry) {
  const bool is_constant = row.use == ProfileUse::constant;
  NewValue value{entry.name, entry.type != nullptr ? entry.type : row.type,
                 is_constant ? "const" : std::string{access_text(entry.access.value_or(row.access))}};
  value.mappable = row.use == ProfileUse::command || row.use == ProfileUse::status;
  if (value.type->bits != 0) value.default_value = "0";
  return value;
}

std::optional<NewObject> object_of_profile(std::uint16_t index, std::uint16_t number, std::uint8_t elements) {
  const MeaningProfile* const profile = find_profile(number);
  if (profile == nullptr) return std::nullopt;
  const std::uint16_t of_first_axis = profile->place_of(index).index;
  const ProfileObject* const row = profile->find(of_first_axis);
  const std::string name = profile->name_of(of_first_axis);
  if (row == nullptr || name.empty()) return std::nullopt;
  const std::span<const ProfileEntry> entries = profile->entries_of(of_first_axis);
  if (row->type == nullptr && entries.empty()) return std::nullopt;
  const ObjectType type = row->object_code == "RECORD" ? ObjectType::record
                          : row->has_sub_indices()     ? ObjectType::array
                                                       : ObjectType::var;
  NewObject object{index, type, name, {}};
  for (const ProfileEntry& entry : entries) object.values.push_back(profile_value(*row, entry));
  if (!entries.empty()) return object;
  for (unsigned i = 1; i <= (row->has_sub_indices() ? elements : 1U); ++i) {
    object.values.push_back(profile_value(*row, {row->has_sub_indices() ? fmt::format("{} {}", name, i) : name}));
  }
  return object;
}

std::string title_of(std::uint16_t index, std::size_t sub_index, SubIndexNotation notation) {
  return notation == SubIndexNotation::decimal ? fmt::format("{:04X}sub{}", index, sub_index)
                                               : fmt::format("{:04X}sub{:X}", index, sub_index);
}

void add_keys_of(const NewValue& value, NewSection& section) {
  const auto add = [&](std::string_view key, std::string text) {
    if (!text.empty()) section.keys.emplace_back(key, std::move(text));
  };
  add("ObjectType", value.type->kind == canopen::DataClass::domain ? "0x2" : "0x7");
  add("DataType", fmt::format("0x{:04X}", static_cast<unsigned>(value.type->type)));
  add("AccessType", value.access);
  add("LowLimit", value.low_limit);
  add("HighLimit", value.high_limit);
  add("DefaultValue", value.default_value);
  add("PDOMapping", value.mappable ? "1" : "0");
  add("Unit", value.unit);
  add("Factor", value.factor);
}

}  // namespace

std::vector<NewSection> sections_of(const NewObject& object, SubIndexNotation notation) {
  NewSection first{fmt::format("{:04X}", object.index), {{"ParameterName", object.name}}};
  if (object.type == ObjectType::var) {
    add_keys_of(object.values.front(), first);
    return {std::move(first)};
  }
  first.keys.emplace_back("ObjectType", fmt::format("0x{:X}", static_cast<unsigned>(object.type)));
  first.keys.emplace_back("SubNumber", fmt::format("{}", object.values.size() + 1));
  std::vector<NewSection> sections{std::move(first)};
  unsigned last = 0;
  for (const NewValue& value : object.values) {
    last = value.sub_index != 0 ? value.sub_index : last + 1U;
    NewSection section{title_of(object.index, last, notation), {{"ParameterName", value.name}}};
    add_keys_of(value, section);
    sections.push_back(std::move(section));
  }
  NewSection count{title_of(object.index, 0, notation), {{"ParameterName", "Highest sub-index supported"}}};
  NewValue count_value{"", canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::unsigned8)),
                       object.has_writable_count ? "rw" : "const"};
  count_value.default_value = object.has_writable_count ? "0" : fmt::format("{}", last);
  add_keys_of(count_value, count);
  sections.insert(sections.begin() + 1, std::move(count));
  return sections;
}

std::optional<NewObject> standard_object(std::uint16_t index, std::uint16_t profile, std::uint8_t elements) {
  if (auto object = object_of_cia301(index, elements)) return object;
  return object_of_profile(index, profile, elements);
}

std::vector<NewSection> copied_sections(const SheetText& text, std::uint16_t from, std::uint16_t to) {
  std::vector<NewSection> sections;
  for (const TextSection& section : text.sections()) {
    if (!is_object_section(section.name.kind) || section.name.index != from || section.title.size() < 4) continue;
    NewSection copy{fmt::format("{:04X}{}", to, section.title.substr(4)), {}};
    for (const IniEntry& entry : text.entries(section)) {
      const bool is_known =
          std::ranges::any_of(copy.keys, [&](const auto& one) { return equal_ignoring_case(one.first, entry.key); });
      if (!is_known) copy.keys.emplace_back(entry.key, entry.value);
    }
    const bool is_new = std::ranges::none_of(
        sections, [&](const NewSection& one) { return equal_ignoring_case(one.title, copy.title); });
    if (is_new) sections.push_back(std::move(copy));
  }
  return sections;
}

std::vector<std::uint16_t> object_indices(const SheetText& text) {
  std::set<std::uint16_t> indices;
  for (const TextSection& section : text.sections()) {
    if (section.name.kind == SectionKind::object) indices.insert(section.name.index);
  }
  return {indices.begin(), indices.end()};
}

}  // namespace edsc
