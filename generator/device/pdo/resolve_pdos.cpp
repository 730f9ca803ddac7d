#include "device/pdo/resolve_pdos.hpp"

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>

#include "device/limits.hpp"

namespace edsc {
namespace {

struct ParameterIndices {
  PdoDirection direction;
  std::uint16_t communication;
  std::uint16_t mapping;
};

constexpr ParameterIndices parameter_indices[] = {
    {PdoDirection::receive, 0x1400, 0x1600},
    {PdoDirection::transmit, 0x1800, 0x1A00},
};

std::uint64_t default_of(const Entry* entry) {
  return entry != nullptr && entry->default_value ? entry->default_value->bits : 0;
}

/// The default mapping: sub-index 0 is the number of objects, sub-indices 1.. the objects.
std::vector<PdoEntry> default_mapping(const Device& device, const Object& mapping) {
  std::vector<PdoEntry> entries;
  const std::uint64_t count = default_of(mapping.find(0));
  if (count >= canopen::source_multiplexed) return entries;
  for (const Entry& parameter : mapping.entries) {
    if (parameter.sub_index == 0 || parameter.sub_index > count) continue;
    const auto value = static_cast<std::uint32_t>(default_of(&parameter));
    if (value == 0) continue;
    PdoEntry entry;
    entry.position = parameter.sub_index;
    entry.index = static_cast<std::uint16_t>(value >> 16);
    entry.sub_index = static_cast<std::uint8_t>(value >> 8);
    entry.bits = static_cast<std::uint8_t>(value);
    entry.dummy = entry.index < 0x20 ? canopen::find_data_type(entry.index) : nullptr;
    entry.object = device.find(entry.index, entry.sub_index);
    entry.place = parameter.default_value ? parameter.default_value->position : parameter.position;
    entries.push_back(entry);
  }
  return entries;
}

bool changes(const Entry& entry, const Options& options) {
  const canopen::AccessRow& access = canopen::row_of(entry.access);
  return (access.readable && access.writable) || options.is_settable(entry.index, entry.sub_index);
}

/// Whether the runtime can process a mapping: a count, followed by UNSIGNED32 entries.
bool is_list_of_objects(const Object& mapping) {
  if (mapping.entries.size() < 2 || mapping.entries.size() > max_mapped_objects + 1) return false;
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

}  // namespace

void resolve_pdos(Device& device, const Options& options) {
  for (const ParameterIndices& indices : parameter_indices) {
    for (std::uint16_t i = 0; i < max_pdos; ++i) {
      const Object* communication = device.find(static_cast<std::uint16_t>(indices.communication + i));
      const Object* mapping = device.find(static_cast<std::uint16_t>(indices.mapping + i));
      if (communication == nullptr && mapping == nullptr) continue;
      Pdo pdo;
      pdo.direction = indices.direction;
      pdo.number = static_cast<std::uint16_t>(i + 1);
      pdo.communication = communication;
      pdo.mapping = mapping;
      pdo.position = communication != nullptr ? communication->position : mapping->position;
      if (mapping != nullptr) pdo.entries = default_mapping(device, *mapping);
      pdo.multiplexed = mapping != nullptr && default_of(mapping->find(0)) >= canopen::source_multiplexed;
      pdo.dynamic = is_dynamic(pdo, options);
      device.pdos.push_back(std::move(pdo));
    }
  }
}

}  // namespace edsc
