#include <fmt/format.h>

#include <algorithm>

#include "device/objects/standard_objects.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "lint/rule_groups.hpp"
#include "text/utf8.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::Access;

constexpr std::size_t longest_name = 241;
constexpr std::uint64_t known_flags = 0x3;  ///< no download of a DCF, no upload for a DCF

/// A constant without a value is always 0 or an empty string.
void check_constant(const RuleContext& context, const Entry& entry) {
  if (entry.access != Access::constant || entry.default_value || entry.type->kind == canopen::DataClass::domain) return;
  if (context.options.is_settable(entry.index, entry.sub_index)) return;
  context.report("const-without-value", entry.position,
                 fmt::format("{} is const and has no DefaultValue", named(entry)));
}

/// Values that differ from the file in a running device. The number of elements and the modes of operation that a drive
/// supports (CiA 402-2: 6502h, of further axes 800h apart) are constants, even if they can be mapped.
bool is_live(const Object& object, const Entry& entry) {
  constexpr EntryKey live[] = {{0x1002, 0}, {0x1018, 4}};
  constexpr std::uint16_t first_application_index = 0x2000, first_profile_index = 0x6000, axis = 0x800, modes = 0x502;
  if (entry.index >= first_application_index && entry.access == Access::ro && entry.pdo_mapping) {
    const bool is_count = object.has_sub_indices() && entry.sub_index == 0;
    const bool is_modes = entry.index >= first_profile_index && entry.index % axis == modes;
    return !is_count && !is_modes;
  }
  return std::ranges::find(live, EntryKey{entry.index, entry.sub_index}) != std::end(live);
}

/// CiA 402: 6061h displays the mode of 6060h, so it has the same default value.
bool shows_a_setting(const RuleContext& context, const Entry& entry) {
  const Entry* const mode = entry.index == 0x6061 ? context.device.find(0x6060, 0) : nullptr;
  return mode != nullptr && mode->default_value && mode->default_value->bits == entry.default_value->bits;
}

/// Before the device measures or counts, such a value is 0.
void check_live(const RuleContext& context, const Object& object, const Entry& entry) {
  if (!entry.default_value || !entry.default_value->clause.empty() || !is_live(object, entry)) return;
  if (entry.default_value->bits == 0 && entry.default_value->bytes.empty()) return;
  if (shows_a_setting(context, entry)) return;
  context.report("live-default", entry.default_value->position,
                 fmt::format("{} has the {} {}, but the running device sets another one", named(entry),
                             context.value_word(entry), written_value(entry.default_value, *entry.type)));
}

void check_mapping(const RuleContext& context, const Entry& entry) {
  const bool has_length = entry.type->kind == canopen::DataClass::string
                              ? mapped_string_capacity(entry, context.options).has_value()
                              : entry.type->bits > 0;
  if (entry.pdo_mapping && !has_length) {
    context.report("mapping-of-no-length", entry.mapping_position,
                   fmt::format("{} is PDO-mappable (PDOMapping=1), but {} is a variable-length data type", named(entry),
                               entry.type->name));
  }
  if (!entry.pdo_mapping && (entry.access == Access::rwr || entry.access == Access::rww)) {
    context.report("process-data-not-mappable", entry.access_position,
                   fmt::format("{} is process data ({}), but not PDO-mappable (PDOMapping=0)", named(entry),
                               canopen::row_of(entry.access).name),
                   {}, std::string{canopen::row_of(entry.access).name});
  }
}

void check_name_length(const RuleContext& context, const Entry& entry) {
  const std::string& name = entry.parameter_name();
  if (name.size() <= longest_name || count_code_points(name) <= longest_name) return;
  context.report("name-length", context.place_of(entry, &EntryDescription::parameter_name),
                 fmt::format("the name of {} has {} characters; the maximum is {}",
                             entry_label(entry.index, entry.sub_index), count_code_points(name), longest_name));
}

void check_flags(const RuleContext& context, const EntryDescription& description) {
  const Field& field = description.obj_flags;
  if (field.empty()) return;
  const auto flags = number_of(field);
  if (flags && (*flags & ~known_flags) == 0) return;
  context.report("object-flags", field.position,
                 fmt::format("ObjFlags defines bits 0 and 1 only; {} sets others", quote(field.text)));
}

/// The elements of an ARRAY have the same data type. Other rules compare the objects of CiA 301.
void check_array(const RuleContext& context, const Object& object) {
  constexpr std::uint8_t structure = 0xFF;
  if (object.type != ObjectType::array || find_standard_object(object.index) != nullptr) return;
  const Entry* first = nullptr;
  for (const Entry& entry : object.entries) {
    if (entry.sub_index == 0 || entry.sub_index == structure) continue;
    if (first == nullptr) first = &entry;
    if (entry.type == first->type) continue;
    context.report("array-data-type", context.place_of(entry, &EntryDescription::data_type),
                   fmt::format("{} is {}, but {} is {}; the elements of an ARRAY have one data type", named(entry),
                               entry.type->name, entry_label(first->index, first->sub_index), first->type->name),
                   {}, fmt::format("{} {}", object.index, entry.type->name));
  }
}

}  // namespace

void check_entries(const RuleContext& context) {
  for (const Object& object : context.device.objects) {
    check_array(context, object);
    for (const Entry& entry : object.entries) {
      check_constant(context, entry);
      check_live(context, object, entry);
      check_mapping(context, entry);
      check_name_length(context, entry);
    }
  }
  for (const ObjectDescription& object : context.sheet.objects) {
    check_flags(context, object);
    for (const SubObjectDescription& sub_object : object.sub_objects) check_flags(context, sub_object);
  }
}

}  // namespace edsc
