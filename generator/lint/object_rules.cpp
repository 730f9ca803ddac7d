#include <fmt/format.h>

#include "device/drive_modes.hpp"
#include "device/objects/standard_objects.hpp"
#include "lint/rule_groups.hpp"
#include "values/read_value.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

/// Checks a default value against its limits, unless it comes from CiA 301.
void check_default(const RuleContext& context, const Entry& entry) {
  if (!entry.default_value || entry.default_value->plus_node_id || !entry.default_value->clause.empty()) return;
  const std::uint64_t value = entry.default_value->bits;
  const bool below = entry.low_limit && is_less(*entry.type, value, entry.low_limit->bits);
  const bool above = entry.high_limit && is_less(*entry.type, entry.high_limit->bits, value);
  if (!accepts_mode(context.device, context.options, entry, value)) {
    context.report("default-outside-limits", entry.default_value->position,
                   fmt::format("the {} {} of {} is not one of the supported drive modes", context.value_word(entry),
                               written_value(entry.default_value, *entry.type), named(entry)));
  }
  if (!below && !above) return;
  context.report("default-outside-limits", entry.default_value->position,
                 fmt::format("the {} {} of {} is {} its limit {}", context.value_word(entry),
                             written_value(entry.default_value, *entry.type), named(entry), below ? "below" : "above",
                             written_value(below ? entry.low_limit : entry.high_limit, *entry.type)),
                 {},
                 fmt::format("{} of {} {}", value, below ? "low" : "high",
                             below ? entry.low_limit->bits : entry.high_limit->bits));
}

}  // namespace

void check_objects(const RuleContext& context) {
  for (const std::uint16_t index : required_objects) {
    // What is described and ignored is reported where it is described.
    if (context.device.find(index) != nullptr || context.sheet.find(index) != nullptr) continue;
    context.report("mandatory-object", context.whole_file(),
                   fmt::format("mandatory object {} is missing", index_label(index)), {}, "missing");
  }
  for (const Object& object : context.device.objects) {
    for (const Entry& entry : object.entries) check_default(context, entry);
  }
}

}  // namespace edsc
