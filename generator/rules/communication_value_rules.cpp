#include <fmt/format.h>

#include <array>

#include "rules/rule_groups.hpp"

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
                     fmt::format("{} watches node {}; 127 is the last", named(entry), node));
    } else if ((value & 0xFFFF) != 0 && node != 0) {
      const Entry*& first = watched[node];
      if (first != nullptr) {
        context.report("heartbeat-consumer", default_place(entry),
                       fmt::format("{} watches node {} a second time", named(entry), node),
                       {{default_place(*first), "the first time"}});
      }
      first = first == nullptr ? &entry : first;
    }
  }
}

/// CiA 301, 7.2.8.2.2: not both at a time; the heartbeat counts.
void check_error_control_values(const RuleContext& context) {
  const Entry* heartbeat = context.device.find(0x1017, 0);
  const Entry* guard_time = context.device.find(0x100C, 0);
  if (default_of(context, 0x1017) == 0 || default_of(context, 0x100C) == 0 || default_of(context, 0x100D) == 0) return;
  context.report("two-error-controls", default_place(*guard_time),
                 "node guarding and heartbeat are both on by default; the heartbeat counts",
                 {{default_place(*heartbeat), "the heartbeat's time"}});
}

/// CiA 301, 7.5.2.22: 0 or 2..240.
void check_sync_counter(const RuleContext& context) {
  const std::uint64_t overflow = default_of(context, 0x1019);
  if (overflow != 1 && overflow <= 240) return;
  const Entry& entry = *context.device.find(0x1019, 0);
  context.report("sync-counter", default_place(entry),
                 fmt::format("{} is 0 or 2..240, not {}", named(entry), overflow));
}

/// CiA 301, 7.5.2.32: 0..2, and 80h and above for the manufacturer.
void check_error_behavior(const RuleContext& context) {
  const Object* object = context.device.find(0x1029);
  if (object == nullptr) return;
  for (const Entry& entry : object->entries) {
    if (entry.sub_index == 0 || !entry.default_value) continue;
    const std::uint64_t value = entry.default_value->bits;
    if (value <= 2 || value >= 0x80) continue;
    context.report("error-behavior", default_place(entry),
                   fmt::format("{} is 0, 1 or 2, or 80h and above; {} is reserved", named(entry), value));
  }
}

/// What reading 1010h and 1011h tells: a few bits, the others 0 (CiA 301, 7.5.2.13 and 7.5.2.14).
struct Capability {
  std::uint16_t index;
  std::uint64_t bits;
};

constexpr Capability capabilities[] = {{0x1010, 0x3}, {0x1011, 0x1}};

void check_capabilities(const RuleContext& context) {
  for (const Capability& row : capabilities) {
    const Object* object = context.device.find(row.index);
    if (object == nullptr) continue;
    for (const Entry& entry : object->entries) {
      if (entry.sub_index == 0 || !entry.default_value || (entry.default_value->bits & ~row.bits) == 0) continue;
      context.report("storage-capability", default_place(entry),
                     fmt::format("{} reads 0x{:X}; only the bits 0x{:X} have a meaning", named(entry),
                                 entry.default_value->bits, row.bits));
    }
  }
}

}  // namespace

void check_communication_values(const RuleContext& context) {
  check_heartbeat_consumer(context);
  check_error_control_values(context);
  check_sync_counter(context);
  check_error_behavior(context);
  check_capabilities(context);
}

}  // namespace edsc
