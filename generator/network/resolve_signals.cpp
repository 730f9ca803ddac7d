#include "network/resolve_signals.hpp"

#include <fmt/format.h>

#include <canopen/od/unit.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "backend/cpp/identifier.hpp"
#include "device/entry_text.hpp"
#include "device/meaning/physical.hpp"
#include "device/meaning/rational.hpp"
#include "device/meaning/raw_unit.hpp"
#include "diagnostics/quote.hpp"
#include "lookup/find_entry.hpp"

namespace edsc {
namespace {

class SignalResolver {
 public:
  SignalResolver(const Network& network, Diagnostics& diagnostics) : network_{network}, diagnostics_{diagnostics} {}

  std::optional<Signal> resolve(const SignalDescription& description) {
    if (!description.from || !description.object) return std::nullopt;
    Signal signal;
    signal.description = &description;
    const NetworkNode* const from = find_node(description.from->value, description.from->position);
    if (from == nullptr) return std::nullopt;
    const bool resolved = from->has_file() ? resolve_from_device(*from, signal) : resolve_from_master(*from, signal);
    if (!resolved || !types_agree(signal)) return std::nullopt;
    check_name(description);
    if (description.unit) {
      signal.quantity = quantity_of(*description.unit, *signal.from.entry);
      check_unit(signal, signal.from);
      for (const SignalEnd& end : signal.to) check_unit(signal, end);
    }
    return signal;
  }

 private:
  bool error(const Position& position, std::string message) {
    diagnostics_.error("network-signal", position, std::move(message));
    return false;
  }

  void check_name(const SignalDescription& description) {
    if (!description.name) return;
    const auto& [name, position] = *description.name;
    if (!is_identifier(name)) {
      error(position, fmt::format("{} is not a name in snake_case, such as \"motor_speed\"", quote(name)));
      return;
    }
    const auto [first, is_new] = names_.emplace(name, position);
    if (is_new) return;
    diagnostics_.error("network-signal", position, fmt::format("two signals have the name {}", quote(name)),
                       {{first->second, "the first one"}});
  }

  /// `rpm`, or with a scale `0.1 degC`.
  std::optional<Quantity> quantity_of(const Written<std::string>& unit, const Entry& entry) {
    const auto invalid = [&](std::string why) {
      error(unit.position, std::move(why));
      return std::nullopt;
    };
    using enum canopen::DataClass;
    const canopen::DataClass kind = entry.type->kind;
    const bool is_number = kind == unsigned_integer || kind == signed_integer || kind == real;
    if (!is_number || (entry.meaning && (entry.meaning->has_fields() || entry.meaning->values))) {
      return invalid(fmt::format("{} is not a number with a unit", named(entry)));
    }
    Quantity quantity;
    std::string_view symbol = unit.value;
    if (const auto parts = split_physical(unit.value)) {
      const auto scale = parse_rational(parts->number);
      if (!scale || *scale == Rational{0}) return invalid(fmt::format("{} is not a scale", quote(parts->number)));
      quantity.scale = *scale;
      symbol = parts->unit;
    }
    quantity.unit = canopen::find_unit(symbol);
    if (quantity.unit == nullptr) return invalid(fmt::format("unknown unit {}", quote(symbol)));
    quantity.symbol = std::string{quantity.unit->symbol};
    quantity.position = unit.position;
    return quantity;
  }

  /// The types of C++ have the units of the EDS and the options file, which a signal therefore completes only.
  void check_unit(const Signal& signal, const SignalEnd& end) {
    const Quantity* const stated = end.node->has_file() ? quantity_with_unit(*end.entry) : nullptr;
    if (!signal.quantity || stated == nullptr || has_same_raw_numbers(*signal.quantity, *stated)) return;
    const auto& [unit, position] = *signal.description->unit;
    error(position, fmt::format("unit {}, but {} of node {} is in {}", quote(unit), named(*end.entry), end.node->name,
                                raw_unit_text(*stated)));
  }

  const NetworkNode* find_node(std::string_view name, const Position& position) {
    const NetworkNode* const node = network_.find(name);
    if (node == nullptr && !network_.lists(name)) error(position, network_.unknown_node(name));
    return node;
  }

  bool resolve_from_device(const NetworkNode& from, Signal& signal) {
    const SignalDescription& description = *signal.description;
    const Entry* const entry =
        find_entry(from, description.object->value, PdoDirection::transmit, description.object->position);
    if (entry == nullptr) return false;
    signal.from = {&from, entry, &from};
    if (description.to.empty()) return error(description.position, "a signal needs \"to\", its receivers");
    for (const Written<std::string>& text : description.to) {
      if (!add_receiver(text, signal)) return false;
    }
    return true;
  }

  /// `"object": "axis1.controlword"` is the entry that receives the signal.
  bool resolve_from_master(const NetworkNode& master, Signal& signal) {
    const SignalDescription& description = *signal.description;
    const auto end = receiver(*description.object);
    if (!end) return false;
    if (!end->node->has_file()) {
      return error(description.object->position,
                   "a signal of a master without a file names the entry that receives it");
    }
    signal.from = {&master, end->entry, end->node};
    signal.to.push_back(*end);
    for (const Written<std::string>& text : description.to) {
      if (!add_receiver(text, signal)) return false;
    }
    return true;
  }

  bool add_receiver(const Written<std::string>& text, Signal& signal) {
    auto end = receiver(text);
    if (!end) return false;
    if (end->entry == nullptr) {
      end->entry = signal.from.entry;
      end->owner = signal.from.owner;
    }
    if (end->node == signal.from.node) return error(text.position, "a node cannot receive its own signal");
    for (const SignalEnd& other : signal.to) {
      if (other.node == end->node) {
        return error(text.position, fmt::format("node {} receives this signal twice", end->node->name));
      }
    }
    signal.to.push_back(*end);
    return true;
  }

  /// `axis1.607Ah`; of a master without a file its name alone, without an entry.
  std::optional<SignalEnd> receiver(const Written<std::string>& text) {
    const std::string_view name = text.value;
    const std::size_t period = name.find('.');
    const NetworkNode* const node = find_node(name.substr(0, period), text.position);
    if (node == nullptr) return std::nullopt;
    if (!node->has_file()) return SignalEnd{node, nullptr, nullptr};
    if (period == std::string_view::npos) {
      error(text.position, fmt::format("{} needs an entry: \"{}.ENTRY\"", quote(name), name));
      return std::nullopt;
    }
    const Entry* const entry = find_entry(*node, name.substr(period + 1), PdoDirection::receive, text.position);
    if (entry == nullptr) return std::nullopt;
    return SignalEnd{node, entry, node};
  }

  const Entry* find_entry(const NetworkNode& node, std::string_view name, PdoDirection direction,
                          const Position& position) {
    const FoundEntry found = entries_.try_emplace(&node, node.named()).first->second.find_one(name);
    if (!found.ok()) {
      error(position, fmt::format("node {}: {}", node.name, found.problem));
      return nullptr;
    }
    const bool receives = direction == PdoDirection::receive;
    if (!allows(found.entry->mappable(), receives ? canopen::Mappable::rpdo : canopen::Mappable::tpdo)) {
      error(position, fmt::format("node {}: {} is not {}PDO-mappable (AccessType {}, PDOMapping {})", node.name,
                                  named(*found.entry), receives ? "R" : "T", canopen::row_of(found.entry->access).name,
                                  found.entry->pdo_mapping ? 1 : 0));
      return nullptr;
    }
    if (found.entry->type->bits == 0) {
      error(position, fmt::format("node {}: {} has the variable-length data type {}", node.name, named(*found.entry),
                                  found.entry->type->name));
      return nullptr;
    }
    return found.entry;
  }

  bool types_agree(const Signal& signal) {
    const Entry& sent = *signal.from.entry;
    for (const SignalEnd& end : signal.to) {
      if (end.entry->type == sent.type) continue;
      return error(signal.description->position,
                   fmt::format("node {} sends {} as {}, node {} receives {} as {}", signal.from.node->name, named(sent),
                               sent.type->name, end.node->name, named(*end.entry), end.entry->type->name));
    }
    return true;
  }

  const Network& network_;
  Diagnostics& diagnostics_;
  std::map<const NetworkNode*, EntryFinder> entries_;
  std::map<std::string, Position> names_;  ///< of signals
};

/// An entry that receives two signals has the value of the one that came last.
void report_shared_receivers(const std::vector<Signal>& signals, Diagnostics& diagnostics) {
  std::map<const Entry*, const Signal*> first;
  for (const Signal& signal : signals) {
    for (const SignalEnd& end : signal.to) {
      if (!end.node->has_file()) continue;
      const auto [at, is_new] = first.emplace(end.entry, &signal);
      if (is_new) continue;
      diagnostics.warning("network-signal", signal.description->position,
                          fmt::format("two signals set {} of node {}", named(*end.entry), end.node->name),
                          {{at->second->description->position, "the first one"}});
    }
  }
}

}  // namespace

std::vector<Signal> resolve_signals(const Network& network, Diagnostics& diagnostics) {
  std::vector<Signal> signals;
  SignalResolver resolver{network, diagnostics};
  for (const SignalDescription& description : network.description.signals) {
    if (auto signal = resolver.resolve(description)) signals.push_back(*std::move(signal));
  }
  report_shared_receivers(signals, diagnostics);
  return signals;
}

}  // namespace edsc
