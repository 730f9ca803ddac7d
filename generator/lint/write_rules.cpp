#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/sync/sync.hpp>

#include "device/index_range.hpp"
#include "device/options/option_table.hpp"
#include "device/pdo/locked_parameters.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

using canopen::CobId;

constexpr std::uint16_t cob_id_sync = 0x1005;
constexpr std::uint16_t cycle_period = 0x1006;
constexpr std::uint16_t cob_id_emcy = 0x1014;
constexpr std::uint16_t sync_overflow = 0x1019;

std::string_view access_name(const Entry& entry) { return canopen::row_of(entry.access).name; }

bool is_writable(const Entry* entry) { return entry != nullptr && canopen::writable(entry->access); }

bool is_set(const RuleContext& context, std::string_view option) {
  return context.options.is_set(*find_flat_option(option));
}

// Entries that no write can change

void report_never(const RuleContext& context, const Entry& entry, std::string_view why, const Entry& by,
                  std::string cause) {
  std::vector<Note> notes;
  if (&by != &entry) notes.push_back({by.access_position, named(by)});
  context.report("never-writable", entry.access_position, fmt::format("no write can change {}: {}", named(entry), why),
                 std::move(notes), std::move(cause));
}

/// Parameters of PDOs that are always valid, if other PDOs of the device can be disabled: no option is implied then.
void check_locked_parameters(const RuleContext& context) {
  for (const ConditionalParameter& parameter : conditional_parameters()) {
    if (is_set(context, parameter.option)) continue;
    for (const LockedParameter& locked : locked_in(context.device, parameter)) {
      report_never(
          context, *locked.entry,
          fmt::format("the {} of {} changes only while the PDO is not valid, and its COB-ID is {}; the option {} "
                      "removes this condition",
                      parameter.name, pdo_label(*locked.pdo), access_name(*locked.cob_id),
                      path_of(*find_flat_option(parameter.option))),
          *locked.cob_id, std::string{parameter.name});
    }
  }
}

/// Why a mapping with writable entries is static in the generated device, and the entry that causes it.
struct StaticMappingCause {
  std::string why;
  const Entry* by = nullptr;
};

StaticMappingCause cause_of(const RuleContext& context, const Pdo& pdo) {
  const Entry* const count = pdo.mapping->find(0);
  if (pdo.mapping->entries.size() == 1)
    return {"it has no sub-indices for mapped objects", &pdo.mapping->entries.front()};
  if (count == nullptr) return {"its sub-index 0 is missing", &pdo.mapping->entries.front()};
  if (!canopen::writable(count->access)) return {fmt::format("its sub-index 0 is {}", access_name(*count)), count};
  for (const Entry& entry : pdo.mapping->entries) {
    if (!canopen::writable(entry.access)) return {fmt::format("{} is {}", named(entry), access_name(entry)), &entry};
    if (!canopen::readable(entry.access)) return {fmt::format("{} is {}", named(entry), access_name(entry)), &entry};
  }
  if (context.options.static_mapping.applies_to(pdo.mapping->index)) {
    return {"the option pdo.static_mapping makes it so", count};
  }
  return {"the device does not support a mapping with these entries that changes", count};
}

/// A mapping is changed as a whole: sub-index 0 is set to 0 first (CiA 301, 7.5.2.36).
void check_static_mapping(const RuleContext& context, const Pdo& pdo) {
  if (pdo.mapping == nullptr || pdo.dynamic || pdo.broken) return;
  const auto writable =
      std::ranges::find_if(pdo.mapping->entries, [](const Entry& entry) { return is_writable(&entry); });
  if (writable == pdo.mapping->entries.end()) return;
  const StaticMappingCause cause = cause_of(context, pdo);
  report_never(context, *writable, fmt::format("the mapping of {} is static, because {}", pdo_label(pdo), cause.why),
               *cause.by, "static mapping");
}

/// 1019h changes only while 1006h is 0 (CiA 301, 7.5.2.22).
void check_sync_overflow(const RuleContext& context) {
  const Entry* const overflow = context.device.find(sync_overflow, 0);
  const Entry* const period = context.device.find(cycle_period, 0);
  if (!is_writable(overflow) || period == nullptr || is_writable(period)) return;
  if (!period->default_value || period->default_value->bits == 0) return;
  report_never(context, *overflow,
               fmt::format("it changes only while 1006h is 0, and {} is {} with the value {}", named(*period),
                           access_name(*period), period->default_value->bits),
               *period, "1006h");
}

// Default values that the device rejects in a write

void report_default(const RuleContext& context, const Entry& entry, std::string_view why, std::string cause) {
  context.report("default-rejected", default_place(entry), fmt::format("the device rejects {}: {}", named(entry), why),
                 {}, std::move(cause));
}

/// 1006h: times of the runtime are at most 2^31 - 1 us.
void check_cycle_period(const RuleContext& context) {
  const Entry* const period = context.device.find(cycle_period, 0);
  if (period == nullptr || !period->default_value || period->type->bits > 32) return;
  const auto value = static_cast<std::uint32_t>(period->default_value->bits);
  if (canopen::is_sync_period(value)) return;
  report_default(context, *period,
                 fmt::format("its {} {} us is above the maximum, 2147483647 us; SYNC is never sent",
                             context.value_word(*period), value),
                 "1006h");
}

/// The bits of a default COB-ID that are no part of its CAN-ID.
void check_cob_id_bits(const RuleContext& context) {
  const Entry* const sync = context.device.find(cob_id_sync, 0);
  const bool generates = sync != nullptr && sync->default_value && (sync->default_value->bits & CobId::no_rtr_bit) != 0;
  if (generates && context.device.find(cycle_period, 0) == nullptr) {
    report_default(context, *sync, "bit 30 lets the device produce SYNC, but 1006h is missing", "bit 30 of 1005h");
  }
  const Entry* const emcy = context.device.find(cob_id_emcy, 0);
  if (emcy != nullptr && emcy->default_value && (emcy->default_value->bits & CobId::no_rtr_bit) != 0) {
    report_default(context, *emcy,
                   fmt::format("bit 30 of its {} is 1, but is reserved and must be 0", context.value_word(*emcy)),
                   "bit 30 of 1014h");
  }
}

/// A COB-ID that is not valid has an 11-bit CAN-ID, too; a valid one is checked by cob-id-frame.
void check_disabled_cob_id(const RuleContext& context, const Entry& entry) {
  const auto row = canopen::find_cob_id_entries(entry.index, entry.sub_index);
  if (!row || !row->has_valid_bit || !is_writable(&entry) || !entry.default_value || entry.type->bits != 32) return;
  const std::uint32_t added = entry.default_value->plus_node_id ? last_node_id : 0;
  const CobId cob_id{static_cast<std::uint32_t>(entry.default_value->bits) + added};
  if (cob_id.valid() || canopen::may_be_written(cob_id, false, true)) return;
  report_default(context, entry,
                 fmt::format("its {} {:08X}h has more than 11 bits, but bit 29 selects an 11-bit CAN-ID",
                             context.value_word(entry), cob_id.value()),
                 "a disabled COB-ID");
}

}  // namespace

void check_writes(const RuleContext& context) {
  check_locked_parameters(context);
  for (const Pdo& pdo : context.device.pdos) check_static_mapping(context, pdo);
  check_sync_overflow(context);
  check_cycle_period(context);
  check_cob_id_bits(context);
  for (const Object& object : context.device.objects) {
    if (object.index >= 0x2000) break;
    for (const Entry& entry : object.entries) check_disabled_cob_id(context, entry);
  }
}

}  // namespace edsc
