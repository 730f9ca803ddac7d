#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/pdo/pdo_parameters.hpp>
#include <canopen/pdo/transmission_type.hpp>

#include "device/pdo/pdo_defaults.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

using canopen::Transmission;

constexpr std::uint8_t cob_id = 1;
constexpr std::uint8_t inhibit_time = 3;
constexpr std::uint8_t compatibility_entry = 4;
constexpr std::uint8_t event_timer = 5;
constexpr std::uint8_t sync_start_value = 6;

bool is_receive(const Pdo& pdo) { return pdo.direction == PdoDirection::receive; }

Transmission transmission_of(std::uint64_t type) {
  return canopen::transmission_of(static_cast<std::uint32_t>(std::min<std::uint64_t>(type, 255)));
}

bool is_synchronous(Transmission transmission) {
  return transmission == Transmission::synchronous || transmission == Transmission::remote_synchronous;
}

/// A PDO has two parameters (CiA 301, 7.5.2.35).
void check_pair(const RuleContext& context, const Pdo& pdo) {
  if (pdo.communication != nullptr && pdo.mapping != nullptr) return;
  const bool has_mapping = pdo.communication == nullptr;
  const int first = is_receive(pdo) ? (has_mapping ? 0x1400 : 0x1600) : (has_mapping ? 0x1800 : 0x1A00);
  const auto missing = static_cast<std::uint16_t>(first + pdo.number - 1);
  context.report("pdo-pair", pdo.position,
                 fmt::format("{} has no {} parameter {}", pdo_label(pdo), has_mapping ? "communication" : "mapping",
                             index_label(missing)),
                 {}, fmt::format("{} {}", is_receive(pdo), has_mapping));
}

void check_transmission_type(const RuleContext& context, const Pdo& pdo, std::uint64_t type) {
  const Entry& entry = *pdo.communication->find(transmission_type_sub_index);
  const Transmission transmission = transmission_of(type);
  if (is_synchronous(transmission) && on_by_default(pdo) && context.device.find(0x1005) == nullptr) {
    context.report("pdo-sync", default_place(entry),
                   fmt::format("{} is synchronous (transmission type {}), but 1005h is missing", pdo_label(pdo), type),
                   {}, "1005h is missing");
  }
}

/// Bit 30 of the COB-ID of a TPDO: no RTR allowed.
void check_remote(const RuleContext& context, const Pdo& pdo, std::uint64_t type) {
  if (is_receive(pdo)) return;
  const Transmission transmission = transmission_of(type);
  const auto value = communication_default(pdo, cob_id);
  const bool remote = transmission == Transmission::remote || transmission == Transmission::remote_synchronous;
  if (!remote || !value || canopen::CobId{static_cast<std::uint32_t>(*value)}.rtr_allowed()) return;
  context.report(
      "pdo-remote", default_place(*pdo.communication->find(transmission_type_sub_index)),
      fmt::format("{} is RTR-only (transmission type {}), but its COB-ID does not allow RTR", pdo_label(pdo), type));
}

void check_time(const RuleContext& context, const Pdo& pdo, std::uint8_t sub_index, bool used, std::uint64_t type) {
  if (used || communication_default(pdo, sub_index).value_or(0) == 0) return;
  const Entry& entry = *pdo.communication->find(sub_index);
  context.report("pdo-time-unused", default_place(entry),
                 is_receive(pdo) ? fmt::format("{} has no effect: {} is not transmitted", named(entry), pdo_label(pdo))
                                 : fmt::format("{} has no effect: {} has transmission type {}", named(entry),
                                               pdo_label(pdo), type));
}

/// Inhibit time and event timer apply to event-driven PDOs; the event timer of an RPDO monitors it.
void check_times(const RuleContext& context, const Pdo& pdo, std::uint64_t type) {
  const auto number = static_cast<std::uint32_t>(type);
  if (!canopen::transmission_type_is_legal(is_receive(pdo), number)) return;
  check_time(context, pdo, inhibit_time, canopen::inhibit_time_is_used(is_receive(pdo), number), type);
  check_time(context, pdo, event_timer, canopen::event_timer_is_used(is_receive(pdo), number), type);
}

/// The event timer is in ms. With an inhibit time longer than its event timer, a PDO is never sent when the timer
/// expires.
void check_inhibit_time(const RuleContext& context, const Pdo& pdo, std::uint64_t type) {
  constexpr std::uint64_t per_millisecond = 1000;
  const std::uint32_t unit = context.options.inhibit_time_unit();
  if (!canopen::inhibit_time_is_used(is_receive(pdo), static_cast<std::uint32_t>(type))) return;
  const std::uint64_t inhibit = communication_default(pdo, inhibit_time).value_or(0) * unit;
  const std::uint64_t timer = communication_default(pdo, event_timer).value_or(0);
  if (timer == 0 || inhibit <= timer * per_millisecond) return;
  const Entry& entry = *pdo.communication->find(inhibit_time);
  const Entry& timer_entry = *pdo.communication->find(event_timer);
  context.report("pdo-inhibit-time", default_place(entry),
                 fmt::format("{} is {}.{} ms (in {} us), longer than the event timer of {}, {} ms", named(entry),
                             inhibit / per_millisecond, inhibit % per_millisecond / 100, unit, pdo_label(pdo), timer),
                 {{default_place(timer_entry), "the event timer"}});
}

void check_compatibility_entry(const RuleContext& context, const Pdo& pdo) {
  const Entry* entry = pdo.communication->find(compatibility_entry);
  if (entry == nullptr) return;
  context.report(
      "pdo-compatibility-entry", entry->position,
      fmt::format("{} of {} is reserved by CiA 301 and must not be implemented", named(*entry), pdo_label(pdo)), {},
      "sub-index 4");
}

void check_sync_start(const RuleContext& context, const Pdo& pdo, std::uint64_t type) {
  const std::uint64_t start = communication_default(pdo, sync_start_value).value_or(0);
  if (start == 0) return;
  const Entry& entry = *pdo.communication->find(sync_start_value);
  const Entry* overflow = context.device.find(0x1019, 0);
  const bool counted = overflow != nullptr && overflow->default_value && overflow->default_value->bits != 0;
  std::string_view why;
  if (pdo.direction == PdoDirection::receive) {
    why = "an RPDO has no SYNC start value";
  } else if (start > 240) {
    why = "the maximum is 240";
  } else if (type < 1 || type > 240) {
    why = "its transmission type is not 1..240";
  } else if (!counted) {
    why = "SYNC is not counted (1019h)";
  } else {
    return;
  }
  context.report("pdo-sync-start", default_place(entry), fmt::format("{} is {}: {}", named(entry), start, why));
}

}  // namespace

void check_pdo_communication(const RuleContext& context) {
  for (const Pdo& pdo : context.device.pdos) {
    check_pair(context, pdo);
    if (pdo.communication == nullptr) continue;
    check_compatibility_entry(context, pdo);
    const auto type = communication_default(pdo, transmission_type_sub_index);
    if (!type) continue;
    check_transmission_type(context, pdo, *type);
    check_remote(context, pdo, *type);
    check_times(context, pdo, *type);
    check_inhibit_time(context, pdo, *type);
    check_sync_start(context, pdo, *type);
  }
}

}  // namespace edsc
