#include "network/assign_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/pdo/transmission_type.hpp>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"
#include "device/options/options.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "network/cob_id_use.hpp"
#include "network/communication_objects.hpp"
#include "network/configured_pdo.hpp"
#include "network/dbc_names.hpp"
#include "network/node_settings.hpp"
#include "network/resolve_signals.hpp"
#include "text/counted.hpp"
#include "text/snake_case.hpp"

namespace edsc {
namespace {

constexpr std::size_t max_entries = 8;  // of a new PDO, as in devices with 8 entries
constexpr std::uint8_t max_sub_index = 254;
constexpr std::uint32_t max_can_id = 0x6DF;       // the IDs above are restricted
constexpr std::uint16_t first_received = 0x2000;  // of a master without a file: + node-ID of the sender
constexpr std::uint16_t first_sent = 0x2100;      // + node-ID of the receiver

/// Signals that share PDOs: one sender, one timing, the same receivers.
struct SignalGroup {
  std::vector<const Signal*> signals;
  unsigned bits = 0;
};

std::uint32_t number_or_0(const WrittenNumber& number) { return number ? number->value : 0; }

/// What the signals of one PDO have in common: sender, timing and receivers.
using SignalKind =
    std::tuple<const NetworkNode*, std::uint32_t, std::uint32_t, std::uint32_t, bool, std::vector<const NetworkNode*>>;

SignalKind kind_of(const Signal& signal) {
  const SignalDescription& timing = *signal.description;
  std::vector<const NetworkNode*> receivers;
  for (const SignalEnd& end : signal.to) receivers.push_back(end.node);
  return {signal.from.node,
          number_or_0(timing.every_ms),
          number_or_0(timing.every_sync),
          number_or_0(timing.inhibit_time_us),
          timing.event && timing.event->value,
          std::move(receivers)};
}

/// The groups of one kind in order, and by the size of a signal the first that may have room for it.
struct GroupsOfKind {
  std::vector<std::size_t> groups;
  std::map<unsigned, std::size_t> first_with_room;
};

/// Each signal is in the first group of its kind that has room for it.
std::vector<SignalGroup> group(const std::vector<Signal>& signals) {
  std::vector<SignalGroup> groups;
  std::map<SignalKind, GroupsOfKind> kinds;
  for (const Signal& signal : signals) {
    const unsigned bits = signal.from.entry->type->bits;
    GroupsOfKind& kind = kinds[kind_of(signal)];
    std::size_t& at = kind.first_with_room[bits];
    const auto has_room = [&](const SignalGroup& one) {
      return one.signals.size() < max_entries && one.bits + bits <= classical_can.bits();
    };
    while (at < kind.groups.size() && !has_room(groups[kind.groups[at]])) ++at;
    if (at == kind.groups.size()) {
      kind.groups.push_back(groups.size());
      groups.emplace_back();
    }
    SignalGroup& chosen = groups[kind.groups[at]];
    chosen.signals.push_back(&signal);
    chosen.bits += bits;
  }
  return groups;
}

MappingValue mapping_value(std::uint16_t index, std::uint8_t sub_index, const Entry& entry) {
  return {index, sub_index, entry.type->bits};
}

/// All CAN-IDs that a device has in a COB-ID that exists.
void add_can_ids(const Device& device, std::set<std::uint32_t>& can_ids) {
  for (const Object& object : device.objects) {
    for (const Entry& entry : object.entries) {
      const CobIdParameter* const row = find_cob_id_parameter(entry.index, entry.sub_index);
      if (row == nullptr || !entry.default_value) continue;
      const canopen::CobId cob_id{static_cast<std::uint32_t>(entry.default_value->bits)};
      if (!row->has_valid_bit || cob_id.valid()) can_ids.insert(cob_id.can_id());
    }
  }
}

class SignalPlanner {
 public:
  SignalPlanner(const Network& network, Diagnostics& diagnostics)
      : network_{network}, diagnostics_{diagnostics}, uses_{cob_id_uses(network)} {
    for (const NetworkNode& node : network.nodes) add_can_ids(node.device(), used_);
  }

  SignalPlan plan(const std::vector<Signal>& signals) {
    for (const SignalGroup& one : group(signals)) add(one);
    return std::move(plan_);
  }

 private:
  using PdoKey = std::tuple<const NetworkNode*, PdoDirection, std::uint16_t>;

  void add(const SignalGroup& group) {
    const Signal& first = *group.signals.front();
    auto sender = choose(*first.from.node, PdoDirection::transmit, sent_mapping(group), first);
    if (!sender) return;
    std::vector<PlannedPdo> receivers;
    for (std::size_t i = 0; i < first.to.size(); ++i) {
      auto receiver = choose(*first.to[i].node, PdoDirection::receive, received_mapping(group, i), first);
      if (!receiver) return;
      receivers.push_back(*std::move(receiver));
    }
    const std::optional<std::uint32_t> cob_id = choose_cob_id(*sender, receivers);
    if (!cob_id) {
      diagnostics_.error("network-signal", first.description->position, "all CAN-IDs for PDOs are in use");
      return;
    }
    add_meanings(group, *sender, receivers, *cob_id);
    sender->cob_id = *cob_id | (sender->cob_id & canopen::CobId::no_rtr_bit);
    set_timing(*first.description, *sender);
    set_inhibit_time(*first.description, *first.from.node, *sender);
    plan_.pdos.push_back(*std::move(sender));
    for (PlannedPdo& receiver : receivers) {
      receiver.cob_id = *cob_id;
      plan_.pdos.push_back(std::move(receiver));
    }
  }

  /// The name and unit of each signal, for all nodes that send or receive it.
  void add_meanings(const SignalGroup& group, const PlannedPdo& sender, const std::vector<PlannedPdo>& receivers,
                    std::uint32_t cob_id) {
    unsigned offset = 0;
    for (std::size_t i = 0; i < group.signals.size(); ++i) {
      const Signal& signal = *group.signals[i];
      const unsigned bits = signal.from.entry->type->bits;
      const WrittenText& stated = signal.description->name;
      std::string name = stated ? stated->value : dbc_signal_name(network_.dbc, cob_id, offset, bits);
      if (!stated && name == usual_name(signal)) name.clear();
      offset += bits;
      if (name.empty() && !signal.quantity) continue;
      add_meaning(sender, i, name, signal);
      for (const PlannedPdo& receiver : receivers) add_meaning(receiver, i, name, signal);
    }
  }

  /// The name that the DBC file of the network gives a signal without a name: `speed`; of a master without a file
  /// `axis1_commands_controlword`.
  static std::string usual_name(const Signal& signal) {
    const std::string identifier = signal.from.owner->named().identifiers().full(*signal.from.entry);
    if (signal.from.node->has_file()) return identifier;
    return fmt::format("{}_{}", to_snake_case(commands_name(signal.from.owner->name)), identifier);
  }

  void add_meaning(const PlannedPdo& pdo, std::size_t position, const std::string& name, const Signal& signal) {
    const MappingValue& value = pdo.mapping[position];
    plan_.meanings.push_back({pdo.node, {value.index, value.sub_index}, name, signal.quantity});
    if (name.empty() || network_.find(pdo.node)->has_file()) return;
    for (MasterEntry& one : plan_.master_entries) {
      if (one.index == value.index && one.sub_index == value.sub_index) one.name = name;
    }
  }

  std::vector<MappingValue> sent_mapping(const SignalGroup& group) {
    std::vector<MappingValue> mapping;
    for (const Signal* const signal : group.signals) mapping.push_back(mapped(signal->from, *signal, true));
    return mapping;
  }

  std::vector<MappingValue> received_mapping(const SignalGroup& group, std::size_t receiver) {
    std::vector<MappingValue> mapping;
    for (const Signal* const signal : group.signals) mapping.push_back(mapped(signal->to[receiver], *signal, false));
    return mapping;
  }

  MappingValue mapped(const SignalEnd& end, const Signal& signal, bool is_sent) {
    const Entry& entry = *end.entry;
    if (end.node->has_file()) return mapping_value(entry.index, entry.sub_index, entry);
    const MasterEntry& copy = master_entry(end, signal.description->position, is_sent);
    return mapping_value(copy.index, copy.sub_index, entry);
  }

  /// The copy of an entry in a master without a file. If its object has the most sub-indices already, reports an error.
  const MasterEntry& master_entry(const SignalEnd& end, const Position& position, bool is_sent) {
    const auto index = static_cast<std::uint16_t>((is_sent ? first_sent : first_received) + end.owner->node_id);
    std::uint8_t sub_index = 1;
    for (const MasterEntry& one : plan_.master_entries) {
      if (one.index != index) continue;
      if (one.original == end.entry) return one;
      if (one.sub_index == max_sub_index) {
        diagnostics_.error("network-signal", position,
                           fmt::format("the master has room for {} entries that it {} node {}", max_sub_index,
                                       is_sent ? "sends to" : "receives from", end.owner->name));
        return one;
      }
      sub_index = static_cast<std::uint8_t>(one.sub_index + 1);
    }
    // The master has the identifier of the signal, as C++ and DBC have it.
    const std::string identifier = end.owner->named().identifiers().full(*end.entry);
    const std::string name = to_snake_case(end.entry->name) == identifier ? end.entry->name : identifier;
    plan_.master_entries.push_back({index, sub_index, end.owner->name, name, end.entry, is_sent});
    return plan_.master_entries.back();
  }

  /// A PDO of the node that has the mapping, or can get it.
  std::optional<PlannedPdo> choose(const NetworkNode& node, PdoDirection direction, std::vector<MappingValue> mapping,
                                   const Signal& first) {
    PlannedPdo planned{node.name, direction, 1, 0, 255, {}, {}, std::move(mapping), first.description->position};
    if (!node.has_file()) {
      planned.number = ++master_pdos_[{&node, direction}];
      if (planned.number <= classical_can.pdos) return planned;
      diagnostics_.error("network-signal", planned.position,
                         fmt::format("the master can have {} {}PDOs at most", classical_can.pdos,
                                     direction == PdoDirection::receive ? "R" : "T"));
      return std::nullopt;
    }
    const Pdo* chosen = find_pdo(node, direction, [&](const Pdo& pdo) {
      return has_mapping(pdo, planned.mapping) && !is_linked_to_another(node, pdo, *first.from.node);
    });
    if (chosen == nullptr) {
      chosen = find_pdo(node, direction, [&](const Pdo& pdo) {
        return pdo.dynamic && pdo.mapping->entries.size() > planned.mapping.size() && !is_known_configured(node, pdo);
      });
    }
    if (chosen == nullptr) {
      const bool receives = direction == PdoDirection::receive;
      diagnostics_.error(
          "network-signal", planned.position,
          fmt::format("node {} does not have a free {}PDO for {}: the others are in use, or their mapping cannot be "
                      "changed{}",
                      node.name, receives ? "R" : "T", counted(planned.mapping.size(), "entry", "entries"),
                      fixed_mapping(node, planned)));
      return std::nullopt;
    }
    taken_.insert({&node, direction, chosen->number});
    planned.number = chosen->number;
    planned.cob_id =
        static_cast<std::uint32_t>(communication_default(*chosen, 1).value_or(canopen::CobId::invalid_bit));
    const auto type = communication_default(*chosen, transmission_type_sub_index).value_or(255);
    planned.transmission_type = static_cast<std::uint8_t>(type);
    planned.has_stated_can_id = has_stated_can_id(node, *chosen);
    return planned;
  }

  /// Names a PDO that maps these entries and others, and whose mapping is fixed or configured; empty if there is none.
  [[nodiscard]] std::string fixed_mapping(const NetworkNode& node, const PlannedPdo& planned) const {
    const Pdo* const pdo = find_pdo(node, planned.direction, [&](const Pdo& one) {
      return std::ranges::all_of(planned.mapping, [&](const MappingValue& value) {
        return std::ranges::any_of(one.entries, [&](const MappingValue& entry) { return entry == value; });
      });
    });
    if (pdo == nullptr) return {};
    std::string labels;
    for (const PdoEntry& entry : pdo->entries) {
      labels += (labels.empty() ? "" : ", ") + entry_label(entry.index, entry.sub_index);
    }
    return fmt::format(
        "; its {} {} {}: it can be used by signals with the same rate and receivers for all of "
        "them, in this order",
        pdo_label(*pdo), pdo->dynamic ? "is configured to map" : "always maps", labels);
  }

  template <class Condition>
  const Pdo* find_pdo(const NetworkNode& node, PdoDirection direction, Condition condition) const {
    const auto at = std::ranges::find_if(node.device().pdos, [&](const Pdo& pdo) {
      return pdo.direction == direction && pdo.communication != nullptr && pdo.mapping != nullptr &&
             !taken_.contains({&node, direction, pdo.number}) && condition(pdo);
    });
    return at == node.device().pdos.end() ? nullptr : &*at;
  }

  [[nodiscard]] bool is_sent_by_another(canopen::CobId cob_id, const NetworkNode& sender) const {
    return std::ranges::any_of(uses_, [&](const CobIdUse& use) {
      return use.transmits && use.extended == cob_id.extended() && use.can_id == cob_id.can_id() && use.node != &sender;
    });
  }

  /// is_configured(), once for each PDO.
  [[nodiscard]] bool is_known_configured(const NetworkNode& node, const Pdo& pdo) const {
    const auto [at, is_new] = configured_.try_emplace({&node, pdo.direction, pdo.number}, false);
    if (is_new) at->second = is_configured(node, pdo);
    return at->second;
  }

  /// Whether `set` or a DCF makes an RPDO receive what a node other than the sender of the signal transmits.
  [[nodiscard]] bool is_linked_to_another(const NetworkNode& node, const Pdo& pdo, const NetworkNode& sender) const {
    if (pdo.direction != PdoDirection::receive || !on_by_default(pdo) || !is_known_configured(node, pdo)) return false;
    const canopen::CobId cob_id{static_cast<std::uint32_t>(communication_default(pdo, 1).value_or(0))};
    return is_sent_by_another(cob_id, sender);
  }

  static bool has_mapping(const Pdo& pdo, const std::vector<MappingValue>& mapping) {
    return std::ranges::equal(pdo.entries, mapping,
                              [](const MappingValue& a, const MappingValue& b) { return a == b; });
  }

  /// The PDO of a signal whose CAN-ID the others get: the sender or receiver with a stated one; else the sender; for a
  /// master without a file the first receiver.
  static const PlannedPdo& leading(const NetworkNode& from, const PlannedPdo& sender,
                                   const std::vector<PlannedPdo>& receivers) {
    if (sender.has_stated_can_id) return sender;
    const auto stated = std::ranges::find(receivers, true, &PlannedPdo::has_stated_can_id);
    if (stated != receivers.end()) return *stated;
    return from.has_file() ? sender : receivers.front();
  }

  /// The CAN-ID of the leading PDO, of 29 bits only if it is stated; a free one if another node transmits that. Nothing
  /// if none is free.
  std::optional<std::uint32_t> choose_cob_id(const PlannedPdo& sender, const std::vector<PlannedPdo>& receivers) {
    const NetworkNode& from = *network_.find(sender.node);
    const PlannedPdo& lead = leading(from, sender, receivers);
    const canopen::CobId own{lead.cob_id};
    const std::uint32_t can_id = own.can_id();
    const bool is_free = !is_sent_by_another(own, from);
    if (lead.has_stated_can_id && own.extended() && is_free) return can_id | canopen::CobId::extended_bit;
    const bool is_usable =
        is_free && !own.extended() && can_id >= canopen::function_code::tpdo1 + 1U && !canopen::is_restricted(can_id);
    if (is_usable && (own.valid() || !used_.contains(can_id)) && assigned_.insert(can_id).second) {
      used_.insert(can_id);
      return can_id;
    }
    std::uint32_t free = canopen::function_code::tpdo1 + 1U;
    while (used_.contains(free) || canopen::is_restricted(free)) {
      if (++free > max_can_id) return std::nullopt;
    }
    used_.insert(free);
    assigned_.insert(free);
    return free;
  }

  static bool is_event_driven(std::uint8_t type) {
    return canopen::transmission_of(type) == canopen::Transmission::event_driven;
  }

  static void set_timing(const SignalDescription& signal, PlannedPdo& sender) {
    if (signal.every_sync) {
      sender.transmission_type = static_cast<std::uint8_t>(signal.every_sync->value);
    } else {
      if (!is_event_driven(sender.transmission_type)) sender.transmission_type = 255;
      sender.event_timer_ms = static_cast<std::uint16_t>(number_or_0(signal.every_ms));
    }
  }

  void set_inhibit_time(const SignalDescription& signal, const NetworkNode& node, PlannedPdo& sender) {
    if (!signal.inhibit_time_us) return;
    const std::uint32_t unit_us = node.has_file() ? node.loaded->options.inhibit_time_unit() : usual_inhibit_time_unit;
    const auto [time_us, position] = *signal.inhibit_time_us;
    if (time_us % unit_us != 0) {
      diagnostics_.error("network-signal", position,
                         fmt::format("the inhibit time of node {} has steps of {} us", node.name, unit_us));
      return;
    }
    sender.inhibit_time = time_us / unit_us;
  }

  const Network& network_;
  Diagnostics& diagnostics_;
  std::vector<CobIdUse> uses_;  ///< as configured without signals
  SignalPlan plan_;
  std::set<PdoKey> taken_;
  mutable std::map<PdoKey, bool> configured_;
  std::map<std::pair<const NetworkNode*, PdoDirection>, std::uint16_t> master_pdos_;
  std::set<std::uint32_t> used_;      ///< CAN-IDs of the devices
  std::set<std::uint32_t> assigned_;  ///< CAN-IDs of planned PDOs
};

/// RPDOs apply at the SYNC what was sent at a SYNC.
void set_receiver_timing(SignalPlan& plan) {
  std::uint8_t sent = 255;
  for (PlannedPdo& pdo : plan.pdos) {
    if (pdo.direction == PdoDirection::transmit) {
      sent = pdo.transmission_type;
    } else if (communication::is_synchronous(pdo.transmission_type) != communication::is_synchronous(sent)) {
      pdo.transmission_type = communication::is_synchronous(sent) ? 1 : 255;
    }
  }
}

/// Sets an entry unless it has the value. A signal does not change what `set` states.
void set_if_different(NetworkNode& node, std::uint16_t index, std::uint8_t sub_index, std::uint64_t number,
                      const Position& position, Diagnostics& diagnostics) {
  const Entry* const entry = node.device().find(index, sub_index);
  if (const Value* const value = entry != nullptr ? node.settings.value_of(*entry) : nullptr) {
    if (value->bits == number) return;
  }
  const Setting* const stated = node.settings.find(index, sub_index);
  if (stated == nullptr) {
    return set_number(node, index, sub_index, number, position, diagnostics);
  }
  const bool is_hexadecimal = sub_index == 1 || contains(mapping_parameters, index);
  diagnostics.error("network-signal", stated->value.position,
                    fmt::format("node {}: {} must be {} for a signal", node.name, named(*entry),
                                is_hexadecimal ? fmt::format("0x{:X}", number) : std::to_string(number)),
                    {{position, "the signal"}});
}

void apply(NetworkNode& node, const PlannedPdo& pdo, Diagnostics& diagnostics) {
  const auto [communication, mapping] = parameters_of(pdo.direction, pdo.number);
  const auto set = [&](std::uint16_t index, std::size_t sub_index, std::uint64_t number) {
    set_if_different(node, index, static_cast<std::uint8_t>(sub_index), number, pdo.position, diagnostics);
  };
  set(communication, 1, pdo.cob_id);
  set(communication, transmission_type_sub_index, pdo.transmission_type);
  const bool has_timer = node.device().find(communication, event_timer_sub_index) != nullptr;
  if (pdo.event_timer_ms && (has_timer || *pdo.event_timer_ms != 0)) {
    set(communication, event_timer_sub_index, *pdo.event_timer_ms);
  }
  if (pdo.inhibit_time) set(communication, inhibit_time_sub_index, *pdo.inhibit_time);
  set(mapping, 0, pdo.mapping.size());
  for (std::size_t i = 0; i < pdo.mapping.size(); ++i) set(mapping, i + 1, pdo.mapping[i].value());
}

}  // namespace

std::string commands_name(const std::string& node) { return fmt::format("{} commands", node); }

SignalPlan plan_signals(const Network& network, Diagnostics& diagnostics) {
  SignalPlan plan = SignalPlanner{network, diagnostics}.plan(resolve_signals(network, diagnostics));
  set_receiver_timing(plan);
  return plan;
}

void apply_signals(NetworkNode& node, const SignalPlan& plan, Diagnostics& diagnostics) {
  for (const PlannedPdo& pdo : plan.pdos) {
    if (pdo.node == node.name) apply(node, pdo, diagnostics);
  }
  for (const SignalMeaning& one : plan.meanings) {
    if (one.node != node.name) continue;
    if (!one.name.empty()) node.signal_names.emplace(one.entry, one.name);
    if (one.quantity) node.signal_quantities.emplace(one.entry, *one.quantity);
  }
}

}  // namespace edsc
