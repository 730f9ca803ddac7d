#include <fmt/format.h>

#include "device/index_range.hpp"
#include "device/objects/object_structure.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t error_history = 0x1003;

/// Objects whose sub-index 0 is not the highest sub-index, but a variable number: of errors, of mapped objects.
bool counts(std::uint16_t index) { return index == error_history || contains(mapping_parameters, index); }

void check_value(const RuleContext& context, const Object& object, const Entry& count) {
  if (!count.default_value || counts(object.index)) return;
  const std::uint64_t value = count.default_value->bits;
  const std::uint8_t highest = object.highest_sub_index();
  if (value == highest) return;
  context.report("sub-index-0-value", count.default_value->position,
                 fmt::format("{} is {}, but the highest sub-index described is {}", named(count), value, highest), {},
                 fmt::format("{:+}", static_cast<std::int64_t>(value) - highest));
}

void check_count(const RuleContext& context, const Object& object) {
  const Entry& count = object.entries.front();
  if (count.sub_index != 0) return;
  if (count.type->type != canopen::DataType::unsigned8) {
    context.report("sub-index-0-type", context.place_of(count, &EntryDescription::data_type),
                   fmt::format("{} is {}; sub-index 0 must be UNSIGNED8", named(count), count.type->name), {},
                   std::string{count.type->name});
  }
  const canopen::AccessRow& access = canopen::row_of(count.access);
  if (object.index == error_history && !(access.readable && access.writable)) {
    const ObjectDescription* const description = context.sheet.find(object.index);
    const bool is_compact = description != nullptr && !description->compact_sub_obj.empty();
    return context.report(
        "sub-index-0-access", count.access_position,
        fmt::format("{} has access {}; it must be rw, because a write of 0 deletes the errors (CiA 301, 7.5.2.4){}",
                    named(count), access.name, is_compact ? "; describe it in [1003sub0]" : ""),
        {}, "1003h");
  }
  const bool may_change = counts(object.index);
  if (!canopen::readable(count.access) || (canopen::writable(count.access) && !may_change)) {
    context.report("sub-index-0-access", count.access_position,
                   fmt::format("{} has access {}; {}", named(count), canopen::row_of(count.access).name,
                               may_change ? "it must be readable" : "the highest sub-index must be const or ro"),
                   {}, std::string{canopen::row_of(count.access).name});
  }
  check_value(context, object, count);
}

/// Sub-index FFh without a default value is 0 in the device.
void check_structure(const RuleContext& context, const Object& object) {
  const Entry* entry = object.find(structure_sub_index);
  if (entry == nullptr) return;
  if (entry->type->type != canopen::DataType::unsigned32) {
    return context.report("sub-index-255", context.place_of(*entry, &EntryDescription::data_type),
                          fmt::format("{} is {}; sub-index FFh describes its object and must be UNSIGNED32",
                                      named(*entry), entry->type->name));
  }
  const ObjectStructure structure = structure_of(object);
  const std::uint64_t value = entry->default_value ? entry->default_value->bits : 0;
  if (structure.matches(value)) return;
  context.report("sub-index-255", entry->default_value ? entry->default_value->position : entry->position,
                 fmt::format("{} is 0x{:X} by default, but the structure of the object is {}", named(*entry), value,
                             structure.text()));
}

}  // namespace

void check_sub_index_0(const RuleContext& context) {
  for (const Object& object : context.device.objects) {
    if (!object.has_sub_indices() || object.entries.empty()) continue;
    check_count(context, object);
    check_structure(context, object);
  }
}

}  // namespace edsc
