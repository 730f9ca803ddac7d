#include "device/pdo/resolve_pdos.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>

namespace edsc {
namespace {

std::uint64_t default_of(const Entry* entry) {
  return entry != nullptr && entry->default_value ? entry->default_value->bits : 0;
}

/// The default mapping: sub-index 0 is the number of objects, sub-indices 1.. the objects.
std::vector<PdoEntry> default_mapping(const Device& device, const Object& mapping) {
  std::vector<PdoEntry> entries;
  const std::uint64_t count = default_of(mapping.find(0));
  if (is_multiplexed(count)) return entries;
  const auto value_of = [&](std::uint8_t sub_index) {
    return static_cast<std::uint32_t>(default_of(mapping.find(sub_index)));
  };
  for (const PlacedObject& mapped : read_mapping(static_cast<std::uint8_t>(count), value_of)) {
    entries.push_back({mapped, device.find(mapped.index, mapped.sub_index), mapped.dummy_type(),
                       default_place(*mapping.find(mapped.position))});
  }
  return entries;
}

bool changes(const Entry& entry, const Options& options) {
  const canopen::AccessRow& access = canopen::row_of(entry.access);
  return (access.readable && access.writable) || options.is_settable(entry.index, entry.sub_index);
}

/// Whether the runtime can process a mapping: a count, followed by UNSIGNED32 entries.
bool is_list_of_objects(const Object& mapping) {
  if (mapping.entries.size() < 2 || mapping.entries.size() > classical_can.objects + 1U) return false;
  for (std::size_t i = 0; i < mapping.entries.size(); ++i) {
    const Entry& entry = mapping.entries[i];
    const auto type = i == 0 ? canopen::DataType::unsigned8 : canopen::DataType::unsigned32;
    if (entry.sub_index != i || entry.type->type != type) return false;
  }
  return true;
}

/// Whether the PDO maps a string, whose length a mapping over the bus cannot express: its entries have the length of
/// their data type.
bool carries_a_string(const Pdo& pdo) {
  return std::ranges::any_of(pdo.entries, [](const PdoEntry& entry) {
    return entry.object != nullptr && entry.object->type->kind == canopen::DataClass::string;
  });
}

/// Whether sub-index 0 includes empty or missing entries: the PDO has the layout without them, which a dynamic mapping
/// cannot express.
bool has_gaps(const Pdo& pdo) { return !pdo.multiplexed && pdo.entries.size() != default_of(pdo.mapping->find(0)); }

/// Whether the mapping can be changed: all entries of its parameter are writable, or set by the application. A PDO
/// without a COB-ID is not served.
bool is_dynamic(const Pdo& pdo, const Options& options) {
  constexpr std::uint8_t cob_id = 1;
  if (pdo.communication == nullptr || pdo.communication->find(cob_id) == nullptr) return false;
  if (pdo.mapping == nullptr || !is_list_of_objects(*pdo.mapping)) return false;
  if (options.static_mapping.applies_to(pdo.mapping->index) || carries_a_string(pdo) || has_gaps(pdo)) return false;
  return std::ranges::all_of(pdo.mapping->entries, [&](const Entry& entry) { return changes(entry, options); });
}

/// Whether the options allow the default COB-ID, which has the CAN-ID of one node or of all.
bool can_id_is_allowed(const Pdo& pdo, const Options& options) {
  const Entry* const entry = pdo.communication == nullptr ? nullptr : pdo.communication->find(1);
  if (entry == nullptr || !entry->default_value || entry->default_value->plus_node_id) return false;
  const canopen::CobId cob_id{static_cast<std::uint32_t>(entry->default_value->bits)};
  return cob_id.valid() && !cob_id.extended() && options.allows_for_pdo(cob_id.can_id());
}

}  // namespace

void resolve_pdos(Device& device, const Options& options) {
  for (const PdoDirection direction : {PdoDirection::receive, PdoDirection::transmit}) {
    for (std::uint16_t number = 1; number <= classical_can.pdos; ++number) {
      const PdoParameterIndices indices = parameters_of(direction, number);
      const Object* communication = device.find(indices.communication);
      const Object* mapping = device.find(indices.mapping);
      if (communication == nullptr && mapping == nullptr) continue;
      Pdo pdo;
      pdo.direction = direction;
      pdo.number = number;
      pdo.communication = communication;
      pdo.mapping = mapping;
      pdo.position = communication != nullptr ? communication->position : mapping->position;
      if (mapping != nullptr) pdo.entries = default_mapping(device, *mapping);
      pdo.multiplexed = mapping != nullptr && is_multiplexed(default_of(mapping->find(0)));
      pdo.dynamic = is_dynamic(pdo, options);
      pdo.can_id_is_allowed = can_id_is_allowed(pdo, options);
      device.pdos.push_back(std::move(pdo));
    }
  }
}

}  // namespace edsc
