#include "device/resolve_pdos.hpp"

#include <algorithm>

namespace edsc {
namespace {

constexpr std::uint16_t most_pdos = 512;

struct ParameterIndices {
  PdoDirection direction;
  std::uint16_t communication;
  std::uint16_t mapping;
};

constexpr ParameterIndices parameter_indices[] = {
    {PdoDirection::receive, 0x1400, 0x1600},
    {PdoDirection::transmit, 0x1800, 0x1A00},
};

std::uint64_t default_of(const Entry* entry) { return entry != nullptr && entry->default_value ? entry->default_value->bits : 0; }

/// The mapping that the defaults give: sub-index 0 counts, sub-indices 1.. name the objects.
std::vector<PdoEntry> default_mapping(const Device& device, const Object& mapping) {
  std::vector<PdoEntry> entries;
  const std::uint64_t count = default_of(mapping.find(0));
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

}  // namespace

void resolve_pdos(Device& device) {
  for (const ParameterIndices& indices : parameter_indices) {
    for (std::uint16_t i = 0; i < most_pdos; ++i) {
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
      device.pdos.push_back(std::move(pdo));
    }
  }
}

}  // namespace edsc
