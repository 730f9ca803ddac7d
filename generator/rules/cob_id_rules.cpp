#include <fmt/format.h>

#include <algorithm>
#include <canopen/cob_id.hpp>
#include <unordered_map>
#include <vector>

#include "rules/rule_groups.hpp"

namespace edsc {
namespace {

using canopen::CobId;

enum class Service : std::uint8_t { sync, time, emcy, sdo_server, sdo_client, rpdo, tpdo };

/// Where COB-IDs stand in the dictionary.
struct CobIdRange {
  std::uint16_t first, last;
  std::uint8_t first_sub_index, last_sub_index;
  Service service;
  bool has_valid_bit;  ///< bit 31: does not exist
};

constexpr CobIdRange cob_id_ranges[] = {
    {0x1005, 0x1005, 0, 0, Service::sync, false},      {0x1012, 0x1012, 0, 0, Service::time, false},
    {0x1014, 0x1014, 0, 0, Service::emcy, true},       {0x1200, 0x127F, 1, 2, Service::sdo_server, true},
    {0x1280, 0x12FF, 1, 2, Service::sdo_client, true}, {0x1400, 0x15FF, 1, 1, Service::rpdo, true},
    {0x1800, 0x19FF, 1, 1, Service::tpdo, true},
};

/// The pre-defined connection set (CiA 301, 7.3.5, table 40): what an entry's COB-ID is for node-ID 0.
struct Predefined {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint16_t function_code;
};

constexpr Predefined predefined[] = {
    {0x1014, 0, canopen::function_code::emcy},         {0x1200, 1, canopen::function_code::sdo_request},
    {0x1200, 2, canopen::function_code::sdo_response}, {0x1400, 1, canopen::function_code::rpdo1},
    {0x1401, 1, canopen::function_code::rpdo2},        {0x1402, 1, canopen::function_code::rpdo3},
    {0x1403, 1, canopen::function_code::rpdo4},        {0x1800, 1, canopen::function_code::tpdo1},
    {0x1801, 1, canopen::function_code::tpdo2},        {0x1802, 1, canopen::function_code::tpdo3},
    {0x1803, 1, canopen::function_code::tpdo4},
};


/// A COB-ID that the device has after a reset.
struct CobIdUse {
  const Entry* entry;
  Service service;
  bool has_valid_bit;
  bool plus_node_id;
  CobId cob_id;  ///< for node-ID 0 when the node-ID is added

  [[nodiscard]] bool valid() const { return !has_valid_bit || cob_id.valid(); }
  [[nodiscard]] CobId of(std::uint32_t node_id) const {
    return plus_node_id ? CobId{cob_id.value() + node_id} : cob_id;
  }
  [[nodiscard]] const Position& place() const { return entry->default_value->position; }
};

const Predefined* find_predefined(const Entry& entry) {
  const auto at = std::ranges::find_if(
      predefined, [&](const Predefined& row) { return row.index == entry.index && row.sub_index == entry.sub_index; });
  return at == std::end(predefined) ? nullptr : &*at;
}

void collect(const Object& object, const CobIdRange& range, std::vector<CobIdUse>& uses) {
  for (const Entry& entry : object.entries) {
    if (entry.sub_index < range.first_sub_index || entry.sub_index > range.last_sub_index) continue;
    if (!entry.default_value || entry.type->kind != canopen::DataClass::unsigned_integer) continue;
    uses.push_back({&entry, range.service, range.has_valid_bit, entry.default_value->plus_node_id,
                    CobId{static_cast<std::uint32_t>(entry.default_value->bits)}});
  }
}

std::vector<CobIdUse> cob_ids_of(const Device& device) {
  std::vector<CobIdUse> uses;
  for (const CobIdRange& range : cob_id_ranges) {
    auto at = std::ranges::lower_bound(device.objects, range.first, {}, &Object::index);
    for (; at != device.objects.end() && at->index <= range.last; ++at) collect(*at, range, uses);
  }
  return uses;
}

/// A PDO whose COB-ID has no default has CAN-ID 0 and is valid.
void check_missing(const RuleContext& context) {
  for (const Pdo& pdo : context.device.pdos) {
    const Entry* entry = pdo.communication == nullptr ? nullptr : pdo.communication->find(1);
    if (entry == nullptr || entry->default_value) continue;
    context.report("cob-id-missing", entry->position,
                   fmt::format("{} has no default: {} gets CAN-ID 0", named(*entry), pdo_label(pdo)));
  }
}

/// Bits 11..28 of a COB-ID with an 11-bit CAN-ID are 0.
void check_frame(const RuleContext& context, const CobIdUse& use) {
  const std::uint32_t highest = use.of(last_node_id).value();
  if (use.cob_id.extended() || (highest & 0x1FFF'F800U) == 0) return;
  context.report(
      "cob-id-frame", use.place(),
      fmt::format("{} has more than 11 bits, but bit 29 says that it is an 11-bit CAN-ID", named(*use.entry)));
}

/// The default SDO's own CAN-IDs are restricted for all others; a client talks to default SDOs of other nodes.
bool may_be_restricted(const CobIdUse& use) { return use.service == Service::sdo_client || use.entry->index == 0x1200; }

void check_restricted(const RuleContext& context, const CobIdUse& use) {
  if (!use.valid() || use.cob_id.extended() || may_be_restricted(use)) return;
  const std::uint32_t first = use.plus_node_id ? 1 : 0;
  const std::uint32_t last = use.plus_node_id ? last_node_id : 0;
  for (std::uint32_t node_id = first; node_id <= last; ++node_id) {
    const std::uint32_t can_id = use.of(node_id).can_id();
    const char* reason = canopen::restriction_of(can_id);
    if (reason == nullptr) continue;
    context.report("cob-id-restricted", use.place(),
                   fmt::format("{} is CAN-ID {:03X}h{}, which is restricted: {}", named(*use.entry), can_id,
                               use.plus_node_id ? fmt::format(" for node-ID {}", node_id) : "", reason));
    return;
  }
}

/// In a sheet for any node-ID, 181h for TPDO 1 is meant as 180h + node-ID.
void check_node_id(const RuleContext& context, const CobIdUse& use) {
  if (context.sheet.is_dcf || context.device.node_id || use.plus_node_id || use.cob_id.extended()) return;
  const Predefined* row = find_predefined(*use.entry);
  if (row == nullptr || use.entry->index == 0x1200) return;
  const std::uint32_t can_id = use.cob_id.can_id();
  if (can_id <= row->function_code || can_id > row->function_code + last_node_id) return;
  context.report(
      "cob-id-node-id", use.place(),
      fmt::format("{} is {:03X}h, the CAN-ID of node {} alone; $NODEID+0x{:X} is that of any node", named(*use.entry),
                  can_id, can_id - row->function_code, row->function_code + (use.cob_id.value() & 0xE000'0000U)));
}

/// CiA 301, 7.5.2.33: the default SDO is 600h and 580h + node-ID.
void check_default_sdo(const RuleContext& context, const CobIdUse& use) {
  if (use.entry->index != 0x1200) return;
  const Predefined& row = *find_predefined(*use.entry);
  const bool right = context.device.node_id ? use.of(*context.device.node_id).value() ==
                                                  std::uint32_t{row.function_code} + *context.device.node_id
                                            : use.plus_node_id && use.cob_id.value() == row.function_code;
  if (right || (context.sheet.is_dcf && !context.device.node_id)) return;
  context.report("default-sdo-cob-id", use.place(),
                 fmt::format("{} of the default SDO is $NODEID+0x{:X}", named(*use.entry), row.function_code));
}

/// The node-ID for which two COB-IDs are the same; 0 when there is none, 255 when they always are.
std::uint32_t common_node_id(const CobIdUse& a, const CobIdUse& b) {
  if (a.cob_id.extended() != b.cob_id.extended()) return 0;
  const std::uint32_t of_a = a.cob_id.can_id();
  const std::uint32_t of_b = b.cob_id.can_id();
  if (a.plus_node_id == b.plus_node_id) return of_a == of_b ? 255 : 0;
  const std::uint32_t node_id = a.plus_node_id ? of_b - of_a : of_a - of_b;
  return node_id >= 1 && node_id <= last_node_id ? node_id : 0;
}

/// Several RPDOs may take the same frame.
bool may_share(const CobIdUse& a, const CobIdUse& b) {
  return a.service == Service::rpdo && b.service == Service::rpdo;
}

void check_pair(const RuleContext& context, const CobIdUse& first, const CobIdUse& second) {
  const std::uint32_t node_id = common_node_id(first, second);
  if (node_id == 0 || may_share(first, second)) return;
  const std::string when = node_id > last_node_id ? "" : fmt::format(" for node-ID {}", node_id);
  context.report("cob-id-twice", second.place(),
                 fmt::format("{} and {} have the same CAN-ID{}", named(*first.entry), named(*second.entry), when),
                 {{first.place(), "the first one"}});
}

/// Each frame has one meaning. SDO clients use the CAN-IDs of other nodes, whatever those are.
void check_duplicates(const RuleContext& context, const std::vector<CobIdUse>& uses) {
  std::unordered_map<std::uint32_t, const CobIdUse*> by_formula;
  std::vector<const CobIdUse*> formulas;
  std::vector<const CobIdUse*> plain;
  for (const CobIdUse& use : uses) {
    if (!use.valid() || use.service == Service::sdo_client) continue;
    if (!use.plus_node_id) {
      plain.push_back(&use);
      continue;
    }
    const auto [first, is_new] = by_formula.try_emplace(use.cob_id.value() & 0x3FFF'FFFFU, &use);
    if (is_new) {
      formulas.push_back(&use);
    } else {
      check_pair(context, *first->second, use);
    }
  }
  for (std::size_t i = 0; i < plain.size(); ++i) {
    for (const CobIdUse* formula : formulas) check_pair(context, *formula, *plain[i]);
    for (std::size_t k = 0; k < i; ++k) check_pair(context, *plain[k], *plain[i]);
  }
}

}  // namespace

void check_cob_ids(const RuleContext& context) {
  check_missing(context);
  const std::vector<CobIdUse> uses = cob_ids_of(context.device);
  for (const CobIdUse& use : uses) {
    check_frame(context, use);
    check_restricted(context, use);
    check_node_id(context, use);
    check_default_sdo(context, use);
  }
  check_duplicates(context, uses);
}

}  // namespace edsc
