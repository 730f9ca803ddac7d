#include <fmt/format.h>

#include "device/objects/standard_objects.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {

namespace {

std::string_view type_name(canopen::DataType type) {
  return canopen::find_data_type(static_cast<std::uint32_t>(type))->name;
}

void check_object_type(const RuleContext& context, const Object& object, const StandardObject& standard) {
  if (object.type == standard.type) return;
  const ObjectDescription* description = context.sheet.find(object.index);
  const bool described = description != nullptr && description->object_type.present;
  context.report("standard-object-type", described ? description->object_type.position : object.position,
                 fmt::format("{} has object code {}; the {} of CiA 301 has {} (clause {})", named(object),
                             to_string(object.type), standard.name, to_string(standard.type), standard.clause),
                 {}, fmt::format("{} {}", standard.first, to_string(object.type)));
}

void check_entry(const RuleContext& context, const Entry& entry, const StandardObject& standard) {
  const StandardEntry* row = find_standard_entry(standard, entry.sub_index);
  if (row == nullptr) {
    context.report("standard-sub-index", entry.position,
                   fmt::format("the {} of CiA 301 has no sub-index {:02X}h (clause {})", standard.name, entry.sub_index,
                               standard.clause),
                   {}, fmt::format("{}", standard.first));
    return;
  }
  if (entry.type->type != row->type) {
    // Only a value that is reported: that of a service has the type of CiA 301, whatever the EDS states.
    context.diagnostics.warning("standard-data-type", context.place_of(entry, &EntryDescription::data_type),
                                fmt::format("{} is {}; CiA 301 requires {} (clause {})", named(entry), entry.type->name,
                                            type_name(row->type), standard.clause),
                                {}, fmt::format("{} {}", standard.first, entry.type->name));
  }
  if (!row->access.has(entry.access)) {
    context.report("standard-access", entry.access_position,
                   fmt::format("{} has access {}, which CiA 301 does not allow (clause {})", named(entry),
                               canopen::row_of(entry.access).name, standard.clause),
                   {}, fmt::format("{} {}", standard.first, canopen::row_of(entry.access).name));
  }
}

void check_required(const RuleContext& context, const Object& object, const StandardObject& standard) {
  for (const StandardEntry& row : standard.entries) {
    if (!row.required || object.find(row.first) != nullptr) continue;
    context.report("standard-sub-index-missing", object.position,
                   fmt::format("{} is missing; CiA 301 requires it for the {} (clause {})",
                               entry_label(object.index, row.first), standard.name, standard.clause),
                   {}, fmt::format("{} {}", standard.first, row.first));
  }
}

void check_object(const RuleContext& context, const Object& object, const StandardObject& standard) {
  check_object_type(context, object, standard);
  if (object.has_sub_indices() != (standard.type != ObjectType::var)) return;  // nothing more can be compared
  for (const Entry& entry : object.entries) {
    const bool count = object.has_sub_indices() && (entry.sub_index == 0 || entry.sub_index == 0xFF);
    if (!count) check_entry(context, entry, standard);
  }
  check_required(context, object, standard);
}

}  // namespace

void check_standard_objects(const RuleContext& context) {
  for (const Object& object : context.device.objects) {
    if (object.index > std::end(standard::objects)[-1].last) break;
    if (const StandardObject* standard = find_standard_object(object.index)) check_object(context, object, *standard);
  }
}

}  // namespace edsc
