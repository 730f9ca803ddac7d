#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "device/meaning/profiles.hpp"
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

std::string_view text_of(ProfileUse use) {
  switch (use) {
    case ProfileUse::command: return "a master writes it";
    case ProfileUse::status: return "the device sets it";
    case ProfileUse::parameter:
    case ProfileUse::constant: break;
  }
  return "it can be read";
}

/// Object code, data types and access of an object against its row. ARRAY and RECORD are not told apart: a master
/// reads both by sub-index.
class ProfileObjectCheck {
 public:
  ProfileObjectCheck(const RuleContext& context, std::string profile, const Object& object, const ProfileObject& row)
      : context_{context}, profile_{std::move(profile)}, object_{object}, row_{row} {}

  void run() const {
    if (object_.has_sub_indices() != row_.has_sub_indices()) return report_object_code();
    if (row_.type == nullptr) return;  // its elements differ
    for (const Entry& entry : object_.entries) {
      if (object_.has_sub_indices() && (entry.sub_index == 0 || entry.sub_index == 0xFF)) continue;
      check_type(entry);
      check_access(entry);
    }
  }

 private:
  void report_object_code() const {
    const ObjectDescription* const description = context_.sheet.find(object_.index);
    const bool is_stated = description != nullptr && description->object_type.present;
    context_.report("profile-object-code", is_stated ? description->object_type.position : object_.position,
                    fmt::format("{} is a {}; {} requires {} {}", index_label(object_.index), to_string(object_.type),
                                profile_, row_.object_code == "ARRAY" ? "an" : "a", row_.object_code));
  }

  void check_type(const Entry& entry) const {
    if (entry.type->type == row_.type->type) return;
    context_.report("profile-data-type", context_.place_of(entry, &EntryDescription::data_type),
                    fmt::format("{} is {}; {} requires {}", named(entry), entry.type->name, profile_, row_.type->name),
                    {}, fmt::format("{} {}", object_.index, entry.type->name));
  }

  void check_access(const Entry& entry) const {
    if (fits(row_.use, entry.access)) return;
    context_.report("profile-access", context_.place_of(entry, &EntryDescription::access_type),
                    fmt::format("{} is {}; in {} it is {}: {}", named(entry), canopen::row_of(entry.access).name,
                                profile_, canopen::row_of(row_.access).name, text_of(row_.use)),
                    {}, fmt::format("{} {}", object_.index, canopen::row_of(entry.access).name));
  }

  const RuleContext& context_;
  const std::string profile_;  ///< for messages
  const Object& object_;
  const ProfileObject& row_;
};

/// The rows of the user replace those of edsc.
void check_profile_objects(const RuleContext& context, std::uint16_t number) {
  const MeaningProfile* const own = find_profile(number);
  const MeaningProfile* const users = context.user_profile;
  const bool applies = users != nullptr && (users->number == 0 || users->number == number);
  for (const Object& object : context.device.objects) {
    const ProfileObject* const users_row = applies ? users->find(object.index) : nullptr;
    const ProfileObject* const own_row = own != nullptr ? own->find(object.index) : nullptr;
    if (users_row != nullptr) {
      ProfileObjectCheck{context, users->title, object, *users_row}.run();
    } else if (own_row != nullptr) {
      ProfileObjectCheck{context, fmt::format("CiA {}", number), object, *own_row}.run();
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
  check_profile_objects(context, profile);
}

}  // namespace edsc
