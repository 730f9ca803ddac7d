#include <fmt/format.h>

#include <algorithm>
#include <canopen/cob_id_check.hpp>
#include <unordered_map>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "rules/rule_groups.hpp"

namespace edsc {
namespace {

using canopen::CobId;

constexpr std::uint16_t default_sdo = 0x1200;

/// A COB-ID that the device has after a reset.
struct CobIdUse {
  const Entry* entry;
  const CobIdParameter* parameter;
  bool plus_node_id;
  CobId cob_id;  ///< for node-ID 0 when the node-ID is added

  [[nodiscard]] bool valid() const { return !parameter->has_valid_bit || cob_id.valid(); }
  [[nodiscard]] CobIdService service() const { return parameter->service; }
  [[nodiscard]] CobId of(std::uint32_t node_id) const {
    return plus_node_id ? CobId{cob_id.value() + node_id} : cob_id;
  }
  [[nodiscard]] Position place() const { return default_place(*entry); }
};

void collect(const Object& object, const CobIdParameter& parameter, std::vector<CobIdUse>& uses) {
  for (const Entry& entry : object.entries) {
    if (entry.sub_index < parameter.first_sub_index || entry.sub_index > parameter.last_sub_index) continue;
    if (entry.type->kind != canopen::DataClass::unsigned_integer) continue;
    const bool known = entry.default_value.has_value();
    uses.push_back({&entry, &parameter, known && entry.default_value->plus_node_id,
                    CobId{known ? static_cast<std::uint32_t>(entry.default_value->bits) : 0}});
  }
}

std::vector<CobIdUse> cob_ids_of(const Device& device) {
  std::vector<CobIdUse> uses;
  for (const CobIdParameter& parameter : cob_id_parameters()) {
    auto at = std::ranges::lower_bound(device.objects, parameter.first, {}, &Object::index);
    for (; at != device.objects.end() && at->index <= parameter.last; ++at) collect(*at, parameter, uses);
  }
  return uses;
}

/// Bits 11..28 of a COB-ID with an 11-bit CAN-ID are 0. One that is off may be anything.
bool check_frame(const RuleContext& context, const CobIdUse& use) {
  const std::uint32_t highest = use.of(last_node_id).value();
  if (!use.valid() || use.cob_id.extended() || (highest & 0x1FFF'F800U) == 0) return true;
  context.report(
      "cob-id-frame", use.place(),
      fmt::format("{} has more than 11 bits, but bit 29 says that it is an 11-bit CAN-ID", named(*use.entry)));
  return false;
}

/// Why a COB-ID has a CAN-ID that its service may not use; null when it may.
const char* restriction_of(const CobIdUse& use, std::uint32_t can_id) {
  if (!canopen::is_restricted_for(use.entry->index, can_id)) return nullptr;
  const char* const reason = canopen::restriction_of(can_id);
  return reason != nullptr ? reason : "SYNC";
}

/// 180h alone for TPDO 1 is meant as 180h + node-ID.
std::string hint(const CobIdUse& use) {
  if (use.plus_node_id || !use.parameter->plus_node_id) return "";
  const std::uint32_t function_code = use.parameter->predefined_of(use.entry->index);
  if (use.cob_id.can_id() != function_code) return "";
  return fmt::format("; $NODEID+0x{:X} adds the node-ID", use.cob_id.value());
}

void check_restricted(const RuleContext& context, const CobIdUse& use) {
  if (!use.valid() || use.cob_id.extended() || use.entry->index == default_sdo) return;
  const std::uint32_t first = use.plus_node_id ? 1 : 0;
  const std::uint32_t last = use.plus_node_id ? last_node_id : 0;
  for (std::uint32_t node_id = first; node_id <= last; ++node_id) {
    const std::uint32_t can_id = use.of(node_id).can_id();
    const char* reason = restriction_of(use, can_id);
    if (reason == nullptr) continue;
    context.report("cob-id-restricted", use.place(),
                   fmt::format("{} is CAN-ID {:03X}h{}, which is restricted ({}){}", named(*use.entry), can_id,
                               use.plus_node_id ? fmt::format(" for node-ID {}", node_id) : "", reason, hint(use)));
    return;
  }
}

/// In a sheet for any node-ID, 181h for TPDO 1 is meant as 180h + node-ID.
void check_node_id(const RuleContext& context, const CobIdUse& use) {
  if (context.sheet.is_dcf || context.device.node_id || use.plus_node_id || use.cob_id.extended()) return;
  if (!use.parameter->plus_node_id) return;
  const std::uint32_t can_id = use.cob_id.can_id();
  const std::uint32_t function_code = use.parameter->predefined_of(use.entry->index);
  if (can_id <= function_code || can_id > function_code + last_node_id) return;
  context.report(
      "cob-id-node-id", use.place(),
      fmt::format("{} is {:03X}h, the CAN-ID of node {} alone; $NODEID+0x{:X} is that of any node", named(*use.entry),
                  can_id, can_id - function_code, function_code + (use.cob_id.value() & 0xE000'0000U)));
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
  return a.service() == CobIdService::rpdo && b.service() == CobIdService::rpdo;
}

void check_pair(const RuleContext& context, const CobIdUse& first, const CobIdUse& second) {
  const std::uint32_t node_id = common_node_id(first, second);
  if (node_id == 0 || may_share(first, second)) return;
  const std::string when = node_id > last_node_id ? "" : fmt::format(" for node-ID {}", node_id);
  context.report("cob-id-twice", second.place(),
                 fmt::format("{} and {} have the same CAN-ID{}", named(*first.entry), named(*second.entry), when),
                 {{first.place(), "the first one"}});
}

/// The CAN-IDs of other nodes, whatever those are.
bool is_of_another_node(const CobIdUse& use) {
  return use.service() == CobIdService::sdo_client || use.service() == CobIdService::emcy_consumer;
}

/// Each frame has one meaning.
void check_duplicates(const RuleContext& context, const std::vector<CobIdUse>& uses) {
  std::unordered_map<std::uint32_t, const CobIdUse*> by_formula;
  std::vector<const CobIdUse*> formulas;
  std::vector<const CobIdUse*> plain;
  for (const CobIdUse& use : uses) {
    if (!use.valid() || is_of_another_node(use)) continue;
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
  const std::vector<CobIdUse> uses = cob_ids_of(context.device);
  for (const CobIdUse& use : uses) {
    if (!check_frame(context, use)) continue;
    check_restricted(context, use);
    check_node_id(context, use);
  }
  check_duplicates(context, uses);
}

}  // namespace edsc
