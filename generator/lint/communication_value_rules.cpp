#include <fmt/format.h>

#include <array>

#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

std::uint64_t default_of(const RuleContext& context, std::uint16_t index) {
  const Entry* entry = context.device.find(index, 0);
  return entry != nullptr && entry->default_value ? entry->default_value->bits : 0;
}

/// CiA 301, 7.5.2.19: bits 24..31 reserved, 16..23 the node-ID, 0..15 the time.
void check_heartbeat_consumer(const RuleContext& context) {
  const Object* object = context.device.find(0x1016);
  if (object == nullptr) return;
  std::array<const Entry*, last_node_id + 1> watched{};
  for (const Entry& entry : object->entries) {
    if (entry.sub_index == 0 || !entry.default_value || entry.default_value->bits == 0) continue;
    const std::uint64_t value = entry.default_value->bits;
    const std::uint64_t node = value >> 16;
    if (node > last_node_id) {
      context.report("heartbeat-consumer", default_place(entry),
                     fmt::format("{} monitors node {}; the maximum node-ID is 127", named(entry), node));
    } else if ((value & 0xFFFF) != 0 && node != 0) {
      const Entry*& first = watched[node];
      if (first != nullptr) {
        context.report("heartbeat-consumer", default_place(entry),
                       fmt::format("{} monitors node {} a second time", named(entry), node),
                       {{default_place(*first), "the first time"}});
      }
      first = first == nullptr ? &entry : first;
    }
  }
}

/// CiA 301, 7.2.8.2.2: not both at the same time; heartbeat is used.
void check_error_control_values(const RuleContext& context) {
  const Entry* heartbeat = context.device.find(0x1017, 0);
  const Entry* guard_time = context.device.find(0x100C, 0);
  if (default_of(context, 0x1017) == 0 || default_of(context, 0x100C) == 0 || default_of(context, 0x100D) == 0) return;
  context.report("two-error-controls", default_place(*guard_time),
                 "node guarding and heartbeat are both enabled by default; heartbeat is used",
                 {{default_place(*heartbeat), "the heartbeat time"}});
}

}  // namespace

void check_communication_values(const RuleContext& context) {
  check_heartbeat_consumer(context);
  check_error_control_values(context);
}

}  // namespace edsc
