#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "change/new_objects.hpp"
#include "device/meaning/profiles.hpp"
#include "device/objects/object_type_name.hpp"
#include "device/objects/standard_objects.hpp"
#include "edit/member_text.hpp"
#include "edit/sheet_parts.hpp"
#include "eds/number.hpp"

namespace edsc::edit {
namespace {

struct ObjectArea {
  std::uint16_t first, last;
  std::string_view name;
};

/// CiA 301, 7.4.2, table 41.
constexpr ObjectArea object_areas[] = {
    {0x0000, 0x0FFF, "Data types"},
    {0x1000, 0x1FFF, "Communication profile"},
    {0x2000, 0x5FFF, "Manufacturer-specific"},
    {0x6000, 0x9FFF, "Standardized profile"},
    {0xA000, 0xFFFF, "Network variables"},
};

/// A key of an entry, and its member in JSON: the columns of the page.
struct EntryColumn {
  std::string_view key, member, label;
  Field EntryDescription::*field;
};

constexpr EntryColumn entry_columns[] = {
    {"ParameterName", "name", "Name", &EntryDescription::parameter_name},
    {"DataType", "type", "Data type", &EntryDescription::data_type},
    {"AccessType", "access", "Access", &EntryDescription::access_type},
    {"PDOMapping", "pdo", "PDO mapping", &EntryDescription::pdo_mapping},
    {"LowLimit", "low", "Low limit", &EntryDescription::low_limit},
    {"HighLimit", "high", "High limit", &EntryDescription::high_limit},
    {"DefaultValue", "default", "Default value", &EntryDescription::default_value},
    {"ParameterValue", "value", "Parameter value", &EntryDescription::parameter_value},
    {"Unit", "unit", "Unit", &EntryDescription::unit},
    {"Factor", "factor", "Factor", &EntryDescription::factor},
};

std::string_view type_text(const EntryDescription& described, const Entry* entry) {
  const canopen::DataTypeRow* const type = entry == nullptr || !described.data_type.present ? nullptr
                                           : entry->stated_type                             ? entry->stated_type
                                                                                            : entry->type;
  return type != nullptr ? type->name : described.data_type.text;
}

/// The directions in which PDOs can map an entry, as a JSON list.
std::string_view directions_of(const Entry* entry) {
  const bool rpdo = entry != nullptr && canopen::allows(entry->mappable(), canopen::Mappable::rpdo);
  const bool tpdo = entry != nullptr && canopen::allows(entry->mappable(), canopen::Mappable::tpdo);
  if (rpdo && tpdo) return R"(["rpdo","tpdo"])";
  return rpdo ? R"(["rpdo"])" : tpdo ? R"(["tpdo"])" : "[]";
}

/// What the file and the device state about an entry.
struct EntryText {
  std::string section;  ///< empty for an element of a compact form
  std::string sub;      ///< two digits; empty for the section of an object with sub-objects
  MemberText members;
};

EntryText described_entry(const OpenSheet& sheet, const EntryDescription& described, std::uint16_t index,
                          std::optional<std::uint8_t> sub_index, bool is_section_of_object) {
  const Entry* const entry = sheet.device && sub_index ? sheet.device->find(index, *sub_index) : nullptr;
  EntryText text{section_of(sheet, index, is_section_of_object ? -1 : int{sub_index.value_or(0)}),
                 sub_index ? fmt::format("{:02X}", *sub_index) : "",
                 {}};
  text.members.add_text("section", text.section).add_text("sub", text.sub);
  for (const EntryColumn& column : entry_columns) {
    const Field& field = described.*column.field;
    if (sub_index && column.field == &EntryDescription::data_type) {
      text.members.add_text(column.member, type_text(described, entry));
    } else if (sub_index && column.field == &EntryDescription::pdo_mapping) {
      text.members.add_flag(column.member, number_of(field).value_or(0) != 0);
    } else {
      text.members.add_text(column.member, field.text);
    }
  }
  if (sub_index) text.members.add_json("mappable", directions_of(entry));
  return text;
}

EntryText compact_entry(const Entry& entry) {
  EntryText text{"", fmt::format("{:02X}", entry.sub_index), {}};
  text.members.add_text("section", "")
      .add_text("sub", text.sub)
      .add_text("name", entry.name)
      .add_text("type", entry.type != nullptr ? entry.type->name : std::string_view{})
      .add_text("access", canopen::row_of(entry.access).name)
      .add_flag("pdo", entry.pdo_mapping);
  for (const std::string_view member : {"low", "high", "default", "value"}) text.members.add_text(member, "");
  text.members.add_text("unit", entry.unit)
      .add_text("factor", entry.factor)
      .add_json("mappable", directions_of(&entry));
  return text;
}

/// Calls `use` with each entry.
template <class Use>
void for_each_entry(const OpenSheet& sheet, const ObjectDescription& described, Use use) {
  const Object* const object = sheet.device ? sheet.device->find(described.index) : nullptr;
  const bool has_subs = !described.sub_objects.empty() || (object != nullptr && object->has_sub_indices());
  const auto own = [&](std::optional<std::uint8_t> sub) {
    return described_entry(sheet, described, described.index, sub, true);
  };
  use(own(has_subs ? std::nullopt : std::optional<std::uint8_t>{0}));
  for (const SubObjectDescription& sub : described.sub_objects) {
    use(described_entry(sheet, sub, described.index, sub.sub_index, false));
  }
  if (object == nullptr || !has_subs || !described.compact_sub_obj.present) return;
  for (const Entry& entry : object->entries) {
    if (described.find(entry.sub_index) == nullptr) use(compact_entry(entry));
  }
}

std::string key_of(const EntryText& entry, std::uint16_t index) {
  return entry.section.empty() ? fmt::format("{:04X}:{}", index, entry.sub) : entry.section;
}

bool is_known_entry(const KnownEntries* earlier, const EntryText& entry, std::uint16_t index) {
  if (earlier == nullptr) return false;
  const auto found = earlier->find(key_of(entry, index));
  return found != earlier->end() && found->second == entry.members.text();
}

/// The PDOs that map an object.
using MappedBy = std::map<std::uint16_t, std::vector<std::string>>;

MappedBy mapped_by(const OpenSheet& sheet) {
  MappedBy result;
  if (!sheet.device) return result;
  for (const Pdo& pdo : sheet.device->pdos) {
    for (const PdoEntry& entry : pdo.entries) {
      std::vector<std::string>& labels = result[entry.index];
      if (labels.empty() || labels.back() != pdo_label(pdo)) labels.push_back(pdo_label(pdo));
    }
  }
  return result;
}

std::string kind_of(const OpenSheet& sheet, const ObjectDescription& described) {
  const Object* const object = sheet.device ? sheet.device->find(described.index) : nullptr;
  if (object != nullptr) return std::string{to_string(object->type)};
  return described.sub_objects.empty() ? "VAR" : "RECORD";
}

std::string object_text(const OpenSheet& sheet, const ObjectDescription& described, const EarlierEntries& earlier,
                        const MappedBy& mapped) {
  std::string entries;
  bool is_changed = false;
  for_each_entry(sheet, described, [&](EntryText entry) {
    const bool is_new = earlier.committed != nullptr && !is_known_entry(earlier.committed, entry, described.index);
    const bool is_of_base = is_known_entry(earlier.base, entry, described.index);
    is_changed = is_changed || is_new;
    entry.members.add_flag("locked", entry.section.empty())
        .add_flag("changed", is_new)
        .add_flag("from_base", is_of_base);
    entries.append(entries.empty() ? "{" : ",{").append(entry.members.text()).append("}");
  });
  const auto labels = mapped.find(described.index);
  MemberText object;
  object.add_text("index", fmt::format("{:04X}", described.index))
      .add_text("name", described.parameter_name.text)
      .add_text("kind", kind_of(sheet, described))
      .add_json("mapped_by", labels == mapped.end() ? "[]" : Json(labels->second).dump())
      .add_flag("changed", is_changed)
      .add_json("entries", fmt::format("[{}]", entries));
  return fmt::format("{{{}}}", object.text());
}

constexpr std::string_view object_kinds[] = {"VAR", "ARRAY", "RECORD"};

}  // namespace

std::string section_of(const OpenSheet& sheet, std::uint16_t index, int sub_index) {
  if (sub_index < 0) return fmt::format("{:04X}", index);
  return sheet.source->choices().sub_indices == SubIndexNotation::decimal
             ? fmt::format("{:04X}sub{}", index, sub_index)
             : fmt::format("{:04X}sub{:X}", index, sub_index);
}

std::uint16_t profile_of(const OpenSheet& sheet) {
  const Entry* const type = sheet.device ? sheet.device->find(0x1000, 0) : nullptr;
  return type != nullptr && type->default_value ? static_cast<std::uint16_t>(type->default_value->bits & 0xFFFFU) : 0;
}

KnownEntries known_entries(const OpenSheet& sheet) {
  KnownEntries known;
  for (const ObjectDescription& described : sheet.sheet.objects) {
    for_each_entry(sheet, described, [&](const EntryText& entry) {
      known.emplace(key_of(entry, described.index), entry.members.text());
    });
  }
  return known;
}

void add_objects(const OpenSheet& sheet, const EarlierEntries& earlier, EditParts& parts) {
  const MappedBy mapped = mapped_by(sheet);
  Json areas = Json::array();
  for (const ObjectArea& area : object_areas) {
    Json indices = Json::array();
    for (const ObjectDescription& described : sheet.sheet.objects) {
      if (described.index >= area.first && described.index <= area.last) {
        indices.push_back(fmt::format("{:04X}", described.index));
      }
    }
    if (indices.empty()) continue;
    areas.push_back({{"id", fmt::format("{:04X}-{:04X}", area.first, area.last)},
                     {"name", area.name},
                     {"objects", std::move(indices)}});
  }
  parts.set("tree", {{"areas", std::move(areas)}});
  for (const ObjectDescription& described : sheet.sheet.objects) {
    parts.set_text(fmt::format("object/{:04X}", described.index), object_text(sheet, described, earlier, mapped));
  }
}

void add_choices(EditParts& parts) {
  Json types = Json::array();
  for (const canopen::DataTypeRow& row : canopen::data_types) {
    types.push_back({{"name", row.name}, {"bits", row.bits}});
  }
  Json access = Json::array();
  for (const canopen::AccessRow& row : canopen::access_rows) access.push_back(row.name);
  Json columns = Json::array();
  for (const EntryColumn& column : entry_columns) {
    columns.push_back({{"key", column.key}, {"member", column.member}, {"label", column.label}});
  }
  parts.set("choices", {{"types", std::move(types)},
                        {"access", std::move(access)},
                        {"kinds", object_kinds},
                        {"columns", std::move(columns)}});
}

void add_standard_objects(const OpenSheet& sheet, EditParts& parts) {
  const std::uint16_t profile = profile_of(sheet);
  std::map<std::uint16_t, std::string> names;
  const auto add = [&](std::uint16_t index) {
    if (sheet.sheet.find(index) != nullptr) return;
    if (const auto object = standard_object(index, profile, 1)) names.emplace(index, object->name);
  };
  for (const StandardObject& row : standard::objects) add(row.first);
  if (const MeaningProfile* const known = find_profile(profile)) {
    for (const ProfileObject& row : known->objects) add(row.index);
  }
  Json objects = Json::array();
  for (const auto& [index, name] : names) {
    objects.push_back({{"index", fmt::format("{:04X}", index)}, {"name", name}});
  }
  parts.set("standard", {{"objects", std::move(objects)}});
}

}  // namespace edsc::edit
