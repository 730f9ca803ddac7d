#include <fmt/format.h>

#include <string_view>

#include "device/objects/standard_objects.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

/// Objects of earlier versions of CiA 301.
struct Obsolete {
  std::uint16_t index;
  std::string_view was;
};

constexpr Obsolete obsolete_objects[] = {
    {0x1004, "number of PDOs supported"},
    {0x100B, "node-ID"},
    {0x100E, "COB-ID guarding protocol"},
    {0x100F, "number of SDOs supported"},
};

constexpr std::uint16_t first_reserved_index = 0xC000;

void check_needs(const RuleContext& context) {
  for (const ObjectNeed& need : object_needs) {
    const Object* object = context.device.find(need.index);
    if (object == nullptr || context.device.find(need.needed) != nullptr) continue;
    context.report("needed-object", object->position,
                   fmt::format("{} requires {} {}, which is not implemented", named(*object), index_label(need.needed),
                               need.what));
  }
}

/// CiA 301, 7.2.8.2.2: a device supports node guarding or heartbeat.
void check_error_control(const RuleContext& context) {
  if (context.device.find(0x1017) != nullptr) return;
  if (context.device.find(0x100C) != nullptr && context.device.find(0x100D) != nullptr) return;
  context.report("error-control", context.whole_file(),
                 "neither heartbeat (1017h) nor node guarding (100Ch, 100Dh) is implemented; one of them is mandatory");
}

/// Additional SDO servers require the default one.
void check_sdo_servers(const RuleContext& context) {
  if (context.device.find(0x1200) != nullptr) return;
  for (const Object& object : context.device.objects) {
    if (object.index < 0x1201 || object.index > 0x127F) continue;
    context.report(
        "default-sdo", object.position,
        fmt::format("{} is an additional SDO server, but the default SDO server 1200h is missing", named(object)));
    return;
  }
}

void check_indices(const RuleContext& context) {
  for (const Obsolete& row : obsolete_objects) {
    const Object* object = context.device.find(row.index);
    if (object == nullptr) continue;
    context.report(
        "obsolete-object", object->position,
        fmt::format("{} is reserved in CiA 301; in earlier versions it was the {}", named(*object), row.was));
  }
  for (auto at = context.device.objects.rbegin(); at != context.device.objects.rend(); ++at) {
    if (at->index < first_reserved_index) break;
    context.report("reserved-index", at->position, fmt::format("{}: C000h to FFFFh are reserved", named(*at)));
  }
}

}  // namespace

void check_presence(const RuleContext& context) {
  check_needs(context);
  check_error_control(context);
  check_sdo_servers(context);
  check_indices(context);
}

}  // namespace edsc
