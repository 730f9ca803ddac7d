#include "network/node_settings.hpp"
#include "network/communication_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "device/drive_modes.hpp"
#include "device/entry_text.hpp"
#include "device/index_range.hpp"
#include "device/meaning/physical.hpp"
#include "device/pdo/fixed_mapping.hpp"
#include "device/reserved_values.hpp"
#include "device/value_overlay.hpp"
#include "diagnostics/quote.hpp"
#include "lookup/find_entry.hpp"
#include "text/ascii.hpp"
#include "values/little_endian.hpp"
#include "values/read_value.hpp"

namespace edsc {
namespace {

/// The entries that the members of a node give a value, and where.
using StatedEntries = std::map<std::pair<std::uint16_t, std::uint8_t>, Position>;

bool same(const Value* a, const Value& b) {
  return a != nullptr && a->bits == b.bits && a->bytes == b.bytes && a->plus_node_id == b.plus_node_id;
}

/// Whether a value of the type can be this number.
bool holds(const canopen::DataTypeRow& type, std::uint64_t number) {
  const bool is_signed = type.kind == canopen::DataClass::signed_integer;
  if (!is_signed && type.kind != canopen::DataClass::unsigned_integer) return false;
  return number <= low_bits(is_signed ? type.bits - 1U : type.bits);
}

bool is_outside_limits(const Entry& entry, const Value& value) {
  if (!value.bytes.empty()) return false;
  return (entry.low_limit && is_less(*entry.type, value.bits, entry.low_limit->bits)) ||
         (entry.high_limit && is_less(*entry.type, entry.high_limit->bits, value.bits));
}

/// Sets a value whose position is that in the network file.
void set_value(NetworkNode& node, const Entry& entry, Value value, Diagnostics& diagnostics) {
  const auto error = [&](std::string_view why) {
    diagnostics.error("network-value", value.position, fmt::format("node {}: {} {}", node.name, named(entry), why));
  };
  const bool changes = !same(node.settings.value_of(entry), value);
  if (changes && !canopen::writable(entry.access)) {
    return error(fmt::format("cannot be written (AccessType {})", canopen::row_of(entry.access).name));
  }
  if (changes && is_of_fixed_mapping(node.device(), entry)) {
    return error("cannot be changed: sub-index 0 of the mapping cannot be written");
  }
  if (is_outside_limits(entry, value)) return error("is outside its limits");
  if (value.bytes.empty() && !accepts_mode(node.device(), node.loaded->options, entry, value.bits)) {
    return error("is not one of the supported drive modes");
  }
  if (const std::string_view why = why_reserved(entry.index, entry.sub_index, value.bits); !why.empty()) {
    return error(fmt::format("must not be {}: {}", value.bits, why));
  }
  node.settings.set(entry, std::move(value));
}

/// Sets an object that the device may lack.
void set_if_present(NetworkNode& node, std::uint16_t index, const WrittenNumber& number, Diagnostics& diagnostics) {
  if (!number || node.device().find(index, 0) == nullptr) return;
  set_number(node, index, 0, number->value, number->position, diagnostics);
}

}  // namespace

void set_number(NetworkNode& node, std::uint16_t index, std::uint8_t sub_index, std::uint64_t number,
                const Position& position, Diagnostics& diagnostics) {
  const Entry* const entry = node.device().find(index, sub_index);
  if (entry == nullptr) {
    diagnostics.error("network-value", position,
                      fmt::format("node {} does not have {}", node.name, entry_label(index, sub_index)));
    return;
  }
  if (!holds(*entry->type, number)) {
    diagnostics.error("network-value", position,
                      fmt::format("node {}: {} does not fit into {}, the data type of {}", node.name, number,
                                  entry->type->name, named(*entry)));
    return;
  }
  const Value* const before = node.settings.value_of(*entry);
  const bool is_hexadecimal = contains(mapping_parameters, index) || (before != nullptr && before->hexadecimal);
  set_value(node, *entry, Value{.bits = number, .hexadecimal = is_hexadecimal, .position = position}, diagnostics);
}

namespace {

bool is_number(canopen::DataClass kind) {
  using enum canopen::DataClass;
  return kind == unsigned_integer || kind == signed_integer || kind == real;
}

/// Reports the findings of the value of a node.
void report_value(const NetworkNode& node, const Diagnostics& of_value, Diagnostics& diagnostics) {
  for (const Diagnostic& one : of_value.all()) {
    diagnostics.error("network-value", one.position, fmt::format("node {}: {}", node.name, one.message));
  }
}

/// A value that is not in the notation of an EDS, and why not.
struct OtherNotation {
  const WrittenValue* written;
  Diagnostics problems;
};

/// A value in the notation of an EDS, of an entry by name or address. `stated` has the entries of the node so far.
/// Returns what is not in this notation: a number with a unit, or a name.
std::optional<OtherNotation> set_text(NetworkNode& node, const WrittenValue& written, EntryFinder& entries,
                                      StatedEntries& stated, Diagnostics& diagnostics) {
  const FoundEntry found = entries.find_one(written.entry.value);
  if (!found.ok()) {
    diagnostics.error("network-value", written.entry.position, fmt::format("node {}: {}", node.name, found.problem));
    return std::nullopt;
  }
  const std::pair key{found.entry->index, found.entry->sub_index};
  const auto [first, is_new] = stated.emplace(key, written.entry.position);
  if (!is_new) {
    diagnostics.error("network-value", written.entry.position,
                      fmt::format("node {} has two values of {}", node.name, named(*found.entry)),
                      {{first->second, "the first one"}});
    return std::nullopt;
  }
  Diagnostics of_value;
  const Field field{written.value.value, written.value.position, true};
  const auto value = parse_exact_value(field, *found.entry->type, node.node_id, of_value);
  if (of_value.errors() > 0 && is_number(found.entry->type->kind)) return OtherNotation{&written, std::move(of_value)};
  report_value(node, of_value, diagnostics);
  if (value && of_value.errors() == 0) set_value(node, *found.entry, *value, diagnostics);
  return std::nullopt;
}

/// The unit of a text such as `2000 rev/s2` or `5rpm`; empty for a number in the notation of an EDS, right or wrong.
std::string unit_of(std::string_view text) {
  const std::optional<PhysicalText> parts = split_physical(text);
  if (!parts) return {};
  const bool is_separate = text.find(' ') != std::string_view::npos;
  return is_separate || canopen::find_unit(parts->unit) != nullptr ? std::string{parts->unit} : std::string{};
}

/// Sets a number with a unit, or the name of a value, as `edsc write` takes it.
void set_with_meaning(NetworkNode& node, const OtherNotation& other, Diagnostics& diagnostics) {
  const Written<std::string>& text = other.written->value;
  const Entry& entry = *EntryFinder{node.named()}.find_one(other.written->entry.value).entry;
  const auto error = [&](const std::string& why) {
    diagnostics.error("network-value", text.position, fmt::format("node {}: {}", node.name, why));
  };
  const std::string unit = unit_of(text.value);
  const Meaning* const meaning = meaning_of_integer(entry);
  const bool has_names = meaning != nullptr && (meaning->values || meaning->has_fields());
  const bool is_name = has_names && !text.value.empty() && is_letter(text.value.front());
  if (unit.empty() && !is_name) return report_value(node, other.problems, diagnostics);
  if (!is_name && quantity_of(entry) == nullptr && !has_names) {
    return error(fmt::format("{} does not have a unit; write the raw number without \"{}\"", named(entry), unit));
  }
  const ParsedValue parsed = parse_value_text(entry, text.value);
  if (!parsed.ok()) return error(parsed.problem);
  std::uint64_t bits = number_of(parsed.bytes);
  if (entry.type->kind == canopen::DataClass::signed_integer) {
    bits = static_cast<std::uint64_t>(sign_extended(bits, entry.type->bits));
  }
  set_value(node, entry, Value{.bits = bits, .position = text.position}, diagnostics);
}

/// The entry of 1016h that monitors this node, else the first one that monitors none; null if there is none.
const Entry* free_consumer(const NetworkNode& node, const Object& object, std::uint8_t monitored) {
  const auto monitors = [&](const Entry& entry, std::uint8_t node_id) {
    const Value* const value = node.settings.value_of(entry);
    const std::uint64_t bits = value != nullptr ? value->bits : 0;
    const bool is_free = (bits & 0xFFFF) == 0 || (bits >> 16 & 0xFF) == 0;
    return entry.sub_index != 0 && (node_id == 0 ? is_free : !is_free && (bits >> 16 & 0xFF) == node_id);
  };
  for (const std::uint8_t node_id : {monitored, std::uint8_t{0}}) {
    const auto found =
        std::ranges::find_if(object.entries, [&](const Entry& entry) { return monitors(entry, node_id); });
    if (found != object.entries.end()) return &*found;
  }
  return nullptr;
}

/// The units that signals state, of entries whose EDS and options file do not state one.
void set_quantities(Device& device, const std::map<EntryKey, Quantity>& quantities) {
  if (quantities.empty()) return;
  for (Object& object : device.objects) {
    for (Entry& entry : object.entries) {
      const auto stated = quantities.find({entry.index, entry.sub_index});
      if (stated == quantities.end()) continue;
      auto meaning = std::make_shared<Meaning>(entry.meaning ? *entry.meaning : Meaning{});
      meaning->quantity = stated->second;
      entry.meaning = std::move(meaning);
    }
  }
}

}  // namespace

void apply_sync(NetworkNode& node, const SyncDescription& sync, Diagnostics& diagnostics) {
  if (sync.producer) {
    const bool is_producer = sync.producer->value == node.name;
    constexpr std::uint32_t produces = canopen::CobId::no_rtr_bit;
    const auto cob_id = value_of(node.device(), communication::cob_id_sync);
    const Position& position = sync.producer->position;
    if (is_producer && !cob_id) {
      diagnostics.error("network-value", position,
                        fmt::format("node {} does not have 1005h and cannot produce SYNC", node.name));
    } else if (cob_id && ((*cob_id & produces) != 0) != is_producer) {
      set_number(node, communication::cob_id_sync, 0, *cob_id ^ produces, position, diagnostics);
    }
    if (is_producer && sync.period_us) {
      set_number(node, communication::cycle_period, 0, sync.period_us->value, sync.period_us->position, diagnostics);
    }
  }
  set_if_present(node, communication::window_length, sync.window_us, diagnostics);
  set_if_present(node, communication::sync_overflow, sync.overflow, diagnostics);
}

void apply_node_members(NetworkNode& node, const SourceFile& network_file, Diagnostics& diagnostics) {
  StatedEntries stated;
  if (const WrittenNumber& time = node.description->heartbeat_ms) {
    set_number(node, communication::producer_heartbeat, 0, time->value, time->position, diagnostics);
    stated.emplace(std::pair{communication::producer_heartbeat, std::uint8_t{0}}, time->position);
  }
  std::vector<OtherNotation> others;
  {
    EntryFinder entries{node.named()};
    for (const WrittenValue& value : node.description->set) {
      if (auto other = set_text(node, value, entries, stated, diagnostics)) others.push_back(*std::move(other));
    }
  }
  if (others.empty()) return;
  Diagnostics of_mapping;                     // reported when all values are set
  configure(node, network_file, of_mapping);  // values of `set` can be the scale of others
  for (const OtherNotation& other : others) set_with_meaning(node, other, diagnostics);
}

void apply_master_timeout(NetworkNode& node, const Network& network, Diagnostics& diagnostics) {
  const WrittenNumber& timeout = node.description->master_timeout_ms;
  if (!timeout) return;
  const auto error = [&](const std::string& why) {
    diagnostics.error("network-value", timeout->position, fmt::format("node {} {}", node.name, why));
  };
  const NetworkNode* const master = network.master();
  if (master == nullptr) return error("cannot monitor a master: no node has \"master\": true");
  if (master == &node) return error("is the master: \"master_timeout_ms\" is for the other nodes");
  const Object* const object = node.device().find(communication::consumer_heartbeat);
  if (object == nullptr) return error("does not have 1016h and cannot monitor the master");
  const Entry* const entry = free_consumer(node, *object, master->node_id);
  if (entry == nullptr) return error("does not have a free entry in 1016h");
  const std::uint32_t value = std::uint32_t{master->node_id} << 16 | timeout->value;
  set_number(node, entry->index, entry->sub_index, value, timeout->position, diagnostics);
}

void configure(NetworkNode& node, const SourceFile& network_file, Diagnostics& diagnostics) {
  if (node.settings.empty() && node.signal_quantities.empty()) return;
  Diagnostics of_mapping;
  Device device = with_values(*node.loaded->device, node.settings, node.loaded->options, of_mapping);
  set_quantities(device, node.signal_quantities);
  node.configured = std::make_unique<const Device>(std::move(device));
  for (const Diagnostic& one : of_mapping.all()) {
    if (one.position.file != &network_file || one.severity != Severity::error) continue;
    diagnostics.error("network-pdo-mapping", one.position, fmt::format("node {}: {}", node.name, one.message));
  }
}

}  // namespace edsc
