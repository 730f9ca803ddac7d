#include "network/node_settings.hpp"
#include "network/communication_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <map>
#include <memory>
#include <utility>

#include "device/drive_modes.hpp"
#include "device/index_range.hpp"
#include "device/pdo/fixed_mapping.hpp"
#include "device/reserved_values.hpp"
#include "device/value_overlay.hpp"
#include "diagnostics/quote.hpp"
#include "lookup/find_entry.hpp"
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

/// A value in the notation of an EDS, of an entry by name or address. `stated` has the entries of the node so far.
void set_text(NetworkNode& node, const WrittenValue& written, EntryFinder& entries, StatedEntries& stated,
              Diagnostics& diagnostics) {
  const FoundEntry found = entries.find_one(written.entry.value);
  if (!found.ok()) {
    diagnostics.error("network-value", written.entry.position, fmt::format("node {}: {}", node.name, found.problem));
    return;
  }
  const std::pair key{found.entry->index, found.entry->sub_index};
  const auto [first, is_new] = stated.emplace(key, written.entry.position);
  if (!is_new) {
    diagnostics.error("network-value", written.entry.position,
                      fmt::format("node {} has two values of {}", node.name, named(*found.entry)),
                      {{first->second, "the first one"}});
    return;
  }
  Diagnostics of_value;
  const Field field{written.value.value, written.value.position, true};
  const auto value = parse_exact_value(field, *found.entry->type, node.node_id, of_value);
  for (const Diagnostic& one : of_value.all()) {
    diagnostics.error("network-value", one.position, fmt::format("node {}: {}", node.name, one.message));
  }
  if (!value || of_value.errors() > 0) return;
  set_value(node, *found.entry, *value, diagnostics);
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

void apply_node_members(NetworkNode& node, Diagnostics& diagnostics) {
  StatedEntries stated;
  if (const WrittenNumber& time = node.description->heartbeat_ms) {
    set_number(node, communication::producer_heartbeat, 0, time->value, time->position, diagnostics);
    stated.emplace(std::pair{communication::producer_heartbeat, std::uint8_t{0}}, time->position);
  }
  EntryFinder entries{node.named()};
  for (const WrittenValue& value : node.description->set) set_text(node, value, entries, stated, diagnostics);
}

void configure(NetworkNode& node, const SourceFile& network_file, Diagnostics& diagnostics) {
  if (node.settings.empty()) return;
  Diagnostics of_mapping;
  node.configured = std::make_unique<const Device>(
      with_values(*node.loaded->device, node.settings, node.loaded->options, of_mapping));
  for (const Diagnostic& one : of_mapping.all()) {
    if (one.position.file != &network_file || one.severity != Severity::error) continue;
    diagnostics.error("network-pdo-mapping", one.position, fmt::format("node {}: {}", node.name, one.message));
  }
}

}  // namespace edsc
