#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "device/pdo/pdo_defaults.hpp"
#include "eds/number.hpp"
#include "lint/rule_groups.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

/// Reports the first of the sub-indices 1..count that is missing, else the first one that is empty.
void check_gaps(const RuleContext& context, const Pdo& pdo, const Entry& count) {
  const std::uint64_t stated = count.default_value->bits;
  const auto last = static_cast<std::uint8_t>(std::min<std::uint64_t>(stated, classical_can.objects));
  const Entry* empty = nullptr;
  for (std::uint8_t i = 1; i <= last; ++i) {
    const Entry* const entry = pdo.mapping->find(i);
    if (entry == nullptr) {
      context.report("pdo-mapping-count", count.default_value->position,
                     fmt::format("{} maps {}, but {} is missing", pdo_label(pdo), counted(stated, "object"),
                                 entry_label(pdo.mapping->index, i)));
      return;
    }
    const bool has_value = entry->default_value && entry->default_value->bits != 0;
    if (empty == nullptr && !has_value) empty = entry;
  }
  if (empty == nullptr) return;
  context.report("pdo-mapping-gap", default_place(*empty),
                 fmt::format("{} maps {}, but {} is empty", pdo_label(pdo), counted(stated, "object"), named(*empty)),
                 {{count.default_value->position, "the number of objects"}},
                 empty->sub_index == 1 ? "counted, but not mapped" : fmt::format("last {}", last - empty->sub_index));
}

/// Dummies may be mapped more than once.
void check_twice(const RuleContext& context, const Pdo& pdo) {
  for (auto second = pdo.entries.begin(); second != pdo.entries.end(); ++second) {
    if (second->object == nullptr) continue;
    const auto first = std::ranges::find(pdo.entries.begin(), second, second->object, &PdoEntry::object);
    if (first == second) continue;
    context.report("pdo-object-twice", second->place,
                   fmt::format("{} maps {} twice, as entries {} and {}", pdo_label(pdo), named(*second->object),
                               first->position, second->position),
                   {{first->place, "the first time"}});
  }
}

void check_empty(const RuleContext& context, const Pdo& pdo, const Entry& count) {
  if (count.default_value->bits != 0 || !on_by_default(pdo)) return;
  context.report("pdo-empty", count.default_value->position,
                 fmt::format("{} is valid, but does not map any object", pdo_label(pdo)), {}, "empty");
}

bool mapping_is_writable(const Pdo& pdo) {
  return pdo.mapping != nullptr &&
         std::ranges::any_of(pdo.mapping->entries, [](const Entry& entry) { return canopen::writable(entry.access); });
}

/// `6041h:00 "Statusword"`, or a dummy's index.
std::string mapped_name(const PdoEntry& entry) {
  return entry.object != nullptr ? named(*entry.object) : entry_label(entry.index, entry.sub_index);
}

/// Granularity is the unit of mapping in bits; 0 means that all mappings are static.
void check_granularity_of_mappings(const RuleContext& context) {
  const Field& field = context.sheet.device_info.granularity;
  const auto granularity = number_of(field);
  if (field.empty() || !granularity) return;
  for (const Pdo& pdo : context.device.pdos) {
    if (*granularity == 0) {
      if (!mapping_is_writable(pdo)) continue;
      context.report(
          "granularity-static", field.position,
          fmt::format("Granularity 0 means static mappings, but the mapping of {} can be changed", pdo_label(pdo)),
          {{pdo.mapping->position, "its mapping parameter"}});
      return;
    }
    const auto finer =
        std::ranges::find_if(pdo.entries, [&](const PdoEntry& entry) { return !entry.is_multiple_of(*granularity); });
    if (finer == pdo.entries.end()) continue;
    context.report("pdo-granularity", finer->place,
                   fmt::format("{} entry {} maps {} of {}, but Granularity is {}", pdo_label(pdo), finer->position,
                               counted(finer->bits, "bit"), mapped_name(*finer), *granularity),
                   {{field.position, "Granularity"}});
    return;
  }
}

/// An entry that the device receives and also transmits.
void check_both_directions(const RuleContext& context) {
  std::unordered_map<const Entry*, const Pdo*> received;
  for (const Pdo& pdo : context.device.pdos) {
    if (!on_by_default(pdo)) continue;
    for (const PdoEntry& entry : pdo.entries) {
      if (entry.object == nullptr) continue;
      if (pdo.direction == PdoDirection::receive) {
        received.try_emplace(entry.object, &pdo);
      } else if (const auto at = received.find(entry.object); at != received.end()) {
        context.report("pdo-both-directions", entry.place,
                       fmt::format("{} entry {} maps {}, which {} also maps", pdo_label(pdo), entry.position,
                                   named(*entry.object), pdo_label(*at->second)));
      }
    }
  }
}

}  // namespace

void check_pdo_mapping(const RuleContext& context) {
  for (const Pdo& pdo : context.device.pdos) {
    const Entry* count = pdo.mapping == nullptr ? nullptr : pdo.mapping->find(0);
    if (count == nullptr || !count->default_value || pdo.multiplexed) continue;
    check_gaps(context, pdo, *count);
    check_twice(context, pdo);
    check_empty(context, pdo, *count);
  }
  check_granularity_of_mappings(context);
  check_both_directions(context);
}

}  // namespace edsc
