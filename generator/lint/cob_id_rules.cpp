#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <canopen/can/cob_id_check.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

using canopen::CobId;

constexpr std::uint16_t default_sdo = 0x1200;
constexpr std::uint32_t flag_bits = CobId::invalid_bit | CobId::no_rtr_bit | CobId::extended_bit;

/// A COB-ID of the device after a reset.
struct CobIdUse {
  const Entry* entry;
  const CobIdParameter* parameter;
  bool plus_node_id;
  CobId cob_id;  ///< for node-ID 0 if the node-ID is added

  [[nodiscard]] bool valid() const { return !parameter->has_valid_bit || cob_id.valid(); }
  [[nodiscard]] CobIdService service() const { return parameter->service; }
  [[nodiscard]] bool is_of_pdo() const { return service() == CobIdService::rpdo || service() == CobIdService::tpdo; }
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

/// The node-ID that a formula adds; nothing if the file has a number.
std::optional<std::uint32_t> added_node_id(const RuleContext& context, const CobIdUse& use) {
  if (use.plus_node_id) return 0;
  const EntryDescription* description = context.describe(*use.entry);
  if (description == nullptr || !context.device.node_id) return std::nullopt;
  const Field& configured = description->parameter_value;
  const Field& field = context.sheet.is_dcf && !configured.empty() ? configured : description->default_value;
  if (field.text.find('$') == std::string_view::npos) return std::nullopt;
  return *context.device.node_id;
}

/// Bits 11..28 of a COB-ID with an 11-bit CAN-ID are 0. A disabled COB-ID is not checked. The node-ID must not change
/// the flags, bits 29 to 31.
bool check_frame(const RuleContext& context, const CobIdUse& use) {
  const std::uint32_t highest = use.of(last_node_id).value();
  const std::uint32_t base = use.cob_id.value() - added_node_id(context, use).value_or(0);
  if (((base ^ highest) & flag_bits) != 0) {
    context.report("cob-id-frame", use.place(),
                   fmt::format("{}: the CAN-ID of $NODEID+0x{:X} has more than 29 bits and changes the flags",
                               named(*use.entry), base));
    return false;
  }
  if (!use.valid() || use.cob_id.extended() || (highest & 0x1FFF'F800U) == 0) return true;
  context.report("cob-id-frame", use.place(),
                 fmt::format("{} has more than 11 bits, but bit 29 selects an 11-bit CAN-ID", named(*use.entry)));
  return false;
}

/// Why a service may not use its CAN-ID; null if it may.
const char* restriction_of(const RuleContext& context, const CobIdUse& use, std::uint32_t can_id) {
  if (!canopen::is_restricted_for(use.entry->index, can_id)) return nullptr;
  if (use.is_of_pdo() && context.options.allows_for_pdo(can_id)) return nullptr;
  const char* const reason = canopen::restriction_of(can_id);
  return reason != nullptr ? reason : "SYNC";
}

/// 180h for TPDO 1 means 180h + node-ID.
bool lacks_node_id(const CobIdUse& use) {
  if (use.plus_node_id || !use.parameter->plus_node_id) return false;
  return use.cob_id.can_id() == use.parameter->predefined_of(use.entry->index);
}

std::string hint(const CobIdUse& use) {
  if (lacks_node_id(use)) return fmt::format("; use $NODEID+0x{:X} to add the node-ID", use.cob_id.value());
  if (use.plus_node_id || !use.is_of_pdo()) return "";
  return "; the option pdo.allowed_can_ids allows a CAN-ID that an application profile defines";
}

/// The CAN-ID of the pre-defined connection set, with the flags that the COB-ID has.
std::string formula_of(const CobIdUse& use) {
  const std::uint32_t flags = use.cob_id.value() & 0xE000'0000U;
  return fmt::format("$NODEID+0x{:X}", use.parameter->predefined_of(use.entry->index) + flags);
}

void offer_formula(const RuleContext& context, AnyRule rule, const CobIdUse& use) {
  context.diagnostics.offer_value(
      rule, use.place(), formula_of(use),
      fmt::format("CAN-ID of {:04X}h for any node (CiA 301, {})", use.entry->index, use.parameter->clause));
}

/// `CAN-ID 6E0h for node-ID 96`, and the other node-IDs with a restricted CAN-ID.
struct RestrictedNodeIds {
  std::uint32_t first = 0, last = 0, count = 0;

  void add(std::uint32_t node_id) {
    first = count == 0 ? node_id : first;
    last = node_id;
    ++count;
  }

  [[nodiscard]] std::string words() const {
    if (count == last_node_id) return " for each node-ID";
    if (count == 1) return fmt::format(" for node-ID {}", first);
    if (count == last - first + 1) return fmt::format(" for node-IDs {} to {}", first, last);
    return fmt::format(" for {} node-IDs from {} to {}", count, first, last);
  }
};

void check_restricted(const RuleContext& context, const CobIdUse& use) {
  if (!use.valid() || use.cob_id.extended() || use.entry->index == default_sdo) return;
  if (!use.plus_node_id) {
    const std::uint32_t can_id = use.cob_id.can_id();
    if (const char* reason = restriction_of(context, use, can_id)) {
      context.report("cob-id-restricted", use.place(),
                     fmt::format("{} is CAN-ID {:03X}h, which is restricted ({}){}", named(*use.entry), can_id, reason,
                                 hint(use)));
      if (lacks_node_id(use)) offer_formula(context, "cob-id-restricted", use);
    }
    return;
  }
  RestrictedNodeIds node_ids;
  for (std::uint32_t node_id = 1; node_id <= last_node_id; ++node_id) {
    if (restriction_of(context, use, use.of(node_id).can_id()) != nullptr) node_ids.add(node_id);
  }
  if (node_ids.count == 0) return;
  const std::uint32_t can_id = use.of(node_ids.first).can_id();
  context.report("cob-id-restricted", use.place(),
                 fmt::format("{} is restricted{} (CAN-ID {:03X}h of node {}: {}){}", named(*use.entry),
                             node_ids.words(), can_id, node_ids.first, restriction_of(context, use, can_id),
                             node_ids.count < last_node_id ? "; a given node-ID is checked alone" : ""));
}

/// $NODEID+0x181 for TPDO 1 is the COB-ID of node 1 plus the node-ID of the device.
void check_added_twice(const RuleContext& context, const CobIdUse& use, std::uint32_t added) {
  const std::uint32_t base = use.cob_id.value() - added;
  const std::uint32_t can_id = CobId{base}.can_id();
  const std::uint32_t function_code = use.parameter->predefined_of(use.entry->index);
  if (can_id <= function_code || can_id > function_code + last_node_id) return;
  const std::uint32_t extra = can_id - function_code;
  context.report(
      "cob-id-node-id", use.place(),
      fmt::format("{} is $NODEID+0x{:X}, which already contains a node-ID: {:03X}h for node 1, the CAN-ID of "
                  "node {}; use $NODEID+0x{:X} to add it once",
                  named(*use.entry), base, can_id + 1, extra + 1, base - extra),
      {}, "added twice");
  offer_formula(context, "cob-id-node-id", use);
}

/// The EDS states a number where the pre-defined connection set adds the node-ID: 181h for TPDO 1 is that of node 1,
/// 200h for RPDO 1 that of each node. In a DCF it may be intended.
void check_node_id(const RuleContext& context, const CobIdUse& use) {
  if (!use.parameter->plus_node_id || use.cob_id.extended() || !use.valid()) return;
  if (use.entry->index == default_sdo) return;  // CiA 301 fixes it
  if (const auto added = added_node_id(context, use)) return check_added_twice(context, use, *added);
  if (context.sheet.is_dcf) return;
  const std::uint32_t can_id = use.cob_id.can_id();
  const std::uint32_t function_code = use.parameter->predefined_of(use.entry->index);
  if (function_code == 0 || can_id < function_code || can_id > function_code + last_node_id) return;
  const std::uint32_t node_id = can_id - function_code;
  const auto& given = context.device.node_id;
  if (given && node_id == *given) return;
  const std::string formula = "use " + formula_of(use);
  if (node_id != 0) {
    context.report("cob-id-node-id", use.place(),
                   fmt::format("{} is {:03X}h, the CAN-ID of node {} {}; {} for any node", named(*use.entry), can_id,
                               node_id, given ? fmt::format("and not of node {}", *given) : "only", formula),
                   {}, fmt::format("node {}", node_id));
    offer_formula(context, "cob-id-node-id", use);
  } else if (restriction_of(context, use, can_id) == nullptr) {
    context.report(
        "cob-id-node-id", use.place(),
        fmt::format("{} is {:03X}h for each node; {} to add the node-ID", named(*use.entry), can_id, formula), {},
        "each node");
    offer_formula(context, "cob-id-node-id", use);
  }
}

/// The node-ID for which a formula gives this CAN-ID; 0 if there is none.
std::uint32_t node_id_of(const CobIdUse& formula, const CobIdUse& plain) {
  if (formula.cob_id.extended() != plain.cob_id.extended()) return 0;
  const std::uint32_t node_id = plain.cob_id.can_id() - formula.cob_id.can_id();
  return node_id >= 1 && node_id <= last_node_id ? node_id : 0;
}

/// The services with the same CAN-ID, in the order of their objects.
struct Users {
  std::vector<const CobIdUse*> all;
  std::vector<std::uint32_t> node_ids;  ///< for which it is the same; empty if it always is

  /// Several RPDOs may receive the same frame.
  [[nodiscard]] bool collide() const {
    const auto is_rpdo = [](const CobIdUse* use) { return use->service() == CobIdService::rpdo; };
    return all.size() > 1 && !std::ranges::all_of(all, is_rpdo);
  }

  [[nodiscard]] std::string when() const {
    if (node_ids.empty()) return "";
    return fmt::format(" for node-ID{} {}", node_ids.size() == 1 ? "" : "s", fmt::join(node_ids, ", "));
  }
};

void report_users(const RuleContext& context, Users users) {
  if (!users.collide()) return;
  std::ranges::sort(users.all, {}, [](const CobIdUse* use) {
    return EntryKey{use->entry->index, use->entry->sub_index};
  });
  std::vector<Note> notes;
  std::string names = named(*users.all.front()->entry);
  for (std::size_t i = 0; i < users.all.size(); ++i) {
    const CobIdUse& use = *users.all[i];
    if (i > 0) names += (i + 1 == users.all.size() ? " and " : ", ") + named(*use.entry);
    if (i != 1) notes.push_back({use.place(), i == 0 ? "the first one" : "another one"});
  }
  const std::string message = fmt::format("{} have the same CAN-ID{}", names, users.when());
  context.report("cob-id-twice", users.all[1]->place(), message, std::move(notes));
}

/// CAN-IDs of other nodes, which are not checked.
bool is_of_another_node(const CobIdUse& use) {
  return use.service() == CobIdService::sdo_client || use.service() == CobIdService::emcy_consumer;
}

/// Each frame has one meaning.
void check_duplicates(const RuleContext& context, const std::vector<CobIdUse>& uses) {
  std::map<std::uint32_t, Users> formulas, plain;  // by CAN-ID and its length
  for (const CobIdUse& use : uses) {
    if (!use.valid() || is_of_another_node(use)) continue;
    (use.plus_node_id ? formulas : plain)[use.cob_id.value() & CobId::identifier].all.push_back(&use);
  }
  for (const auto& [can_id, users] : formulas) report_users(context, users);
  for (auto& [can_id, users] : plain) {
    const CobIdUse& number = *users.all.front();
    for (const auto& [base, of_formula] : formulas) {
      const std::uint32_t node_id = node_id_of(*of_formula.all.front(), number);
      if (node_id == 0) continue;
      users.all.insert(users.all.end(), of_formula.all.begin(), of_formula.all.end());
      users.node_ids.push_back(node_id);
    }
    report_users(context, users);
  }
}

/// A frame with the CAN-ID of SYNC is a SYNC for all other nodes, even if the device itself does not support SYNC.
void check_sync_can_id(const RuleContext& context, const CobIdUse& use) {
  const bool is_sync = !use.plus_node_id && use.cob_id.can_id() == canopen::function_code::sync;
  if (use.service() != CobIdService::tpdo || !use.valid() || use.cob_id.extended() || !is_sync) return;
  if (context.device.find(0x1005) != nullptr) return;  // then it is one of two with the same CAN-ID
  context.report("cob-id-twice", use.place(),
                 fmt::format("{} is CAN-ID 080h, which is SYNC for all other nodes{}", named(*use.entry), hint(use)));
}

}  // namespace

void check_cob_ids(const RuleContext& context) {
  const std::vector<CobIdUse> uses = cob_ids_of(context.device);
  for (const CobIdUse& use : uses) {
    if (!check_frame(context, use)) continue;
    check_restricted(context, use);
    check_node_id(context, use);
    check_sync_can_id(context, use);
  }
  check_duplicates(context, uses);
}

}  // namespace edsc
