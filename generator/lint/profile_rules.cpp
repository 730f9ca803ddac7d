#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "lint/profile_objects.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

bool has_any(const Device& device, std::uint16_t first, std::uint16_t last) {
  const auto at = std::ranges::lower_bound(device.objects, first, {}, &Object::index);
  return at != device.objects.end() && at->index <= last;
}

/// CiA 401-1, 5.2: bits of 1000h, and the objects with the values.
struct IoKind {
  unsigned bit;
  std::string_view name;
  std::uint16_t first, last;
  std::uint16_t usual;
};

constexpr IoKind io_kinds[] = {
    {16, "digital inputs", 0x6000, 0x617F, 0x6000},
    {17, "digital outputs", 0x6200, 0x637F, 0x6200},
    {18, "analogue inputs", 0x6400, 0x640F, 0x6401},
    {19, "analogue outputs", 0x6410, 0x641F, 0x6411},
};

constexpr std::uint32_t all_io_kinds = 0x000F'0000;

// clang 14 crashes where a conditional expression looks up a rule.
constexpr AnyRule missing_object{"profile-401-object"};
constexpr AnyRule unnamed_kind{"io-kinds"};

void check_io_modules(const RuleContext& context, const Entry& device_type) {
  const auto bits = static_cast<std::uint32_t>(device_type.default_value->bits);
  if ((bits & all_io_kinds) == 0) {
    context.report("io-kinds", default_place(device_type),
                   fmt::format("{} states CiA 401, but neither inputs nor outputs (bits 16..19)", named(device_type)));
    return;
  }
  for (const IoKind& kind : io_kinds) {
    const bool said = (bits >> kind.bit & 1U) != 0;
    const bool there = has_any(context.device, kind.first, kind.last);
    if (said == there) continue;
    const std::string message = said ? fmt::format("{} states {} (bit {}), but {} is missing", named(device_type),
                                                   kind.name, kind.bit, index_label(kind.usual))
                                     : fmt::format("the device has objects for {}, but {} does not state them (bit {})",
                                                   kind.name, named(device_type), kind.bit);
    context.report(said ? missing_object : unnamed_kind, default_place(device_type), message);
  }
}

void check_needed(const RuleContext& context, const Entry& device_type, std::uint16_t profile) {
  for (const ProfileNeed& need : profile_needs) {
    if (need.profile != profile) continue;
    const bool there = std::ranges::any_of(
        need.one_of, [&](std::uint16_t index) { return index != 0 && context.device.find(index) != nullptr; });
    if (there) continue;
    context.report(need.rule, default_place(device_type),
                   fmt::format("{} states CiA {}, but {} {} is missing", named(device_type), profile,
                               index_label(need.one_of[0]), need.name));
  }
}

/// The elements of an ARRAY have the same type.
void check_types(const RuleContext& context, std::uint16_t profile) {
  for (const ProfileType& row : profile_types) {
    const Object* object = row.profile == profile ? context.device.find(row.index) : nullptr;
    if (object == nullptr) continue;
    for (const Entry& entry : object->entries) {
      if (object->has_sub_indices() && (entry.sub_index == 0 || entry.sub_index == 0xFF)) continue;
      if (entry.type->type == row.type) continue;
      context.report("profile-data-type", context.place_of(entry, &EntryDescription::data_type),
                     fmt::format("{} is {}; CiA {} requires {}", named(entry), entry.type->name, profile,
                                 canopen::find_data_type(static_cast<std::uint32_t>(row.type))->name),
                     {}, fmt::format("{} {}", object->index, entry.type->name));
    }
  }
}

}  // namespace

void check_profile(const RuleContext& context) {
  const Entry* device_type = context.device.find(0x1000, 0);
  if (device_type == nullptr) return;
  if (!device_type->default_value) {
    context.report("device-type", device_type->position,
                   fmt::format("{} has no default value, so the device profile is unknown", named(*device_type)));
    return;
  }
  const auto profile = static_cast<std::uint16_t>(device_type->default_value->bits);
  if (profile == 401) check_io_modules(context, *device_type);
  check_needed(context, *device_type, profile);
  check_types(context, profile);
}

}  // namespace edsc
