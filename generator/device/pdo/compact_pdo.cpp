#include "device/pdo/resolve_pdos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "device/complete_device.hpp"
#include "device/resolve_information.hpp"

namespace edsc {
namespace {

using canopen::Access;
using canopen::DataType;

constexpr std::uint32_t known_bits = 0x3F;

struct Direction {
  std::string_view name;
  PdoDirection direction;
  Field DeviceInfo::*count;
};

constexpr Direction directions[] = {
    {"RPDO", PdoDirection::receive, &DeviceInfo::nr_of_rx_pdo},
    {"TPDO", PdoDirection::transmit, &DeviceInfo::nr_of_tx_pdo},
};

struct CommunicationSub {
  std::string_view name;
  DataType type;
};

constexpr std::string_view transmission_type = "Transmission type";

/// Sub-indices 1 to 6 of a communication parameter (CiA 301, 7.5.2.35).
constexpr CommunicationSub communication_subs[] = {
    {"COB-ID", DataType::unsigned32},       {transmission_type, DataType::unsigned8},
    {"Inhibit time", DataType::unsigned16}, {"Compatibility entry", DataType::unsigned8},
    {"Event timer", DataType::unsigned16},  {"SYNC start value", DataType::unsigned8},
};

class CompactPdos {
 public:
  CompactPdos(std::uint32_t mask, const Position& position, Device& device)
      : mask_{mask}, position_{position}, device_{device} {}

  void add(const Direction& direction, std::uint32_t count) {
    const std::uint32_t described = count_described(direction);
    std::uint32_t missing = count > described ? count - described : 0;
    for (std::uint16_t number = 1; number <= classical_can.pdos; ++number) {
      const PdoParameterIndices indices = parameters_of(direction.direction, number);
      const bool is_described = has_one_of(indices);
      if (!is_described && missing == 0) continue;
      if (!is_described) --missing;
      if (!has(indices.communication)) added_.push_back(communication(direction, indices.communication, number));
      if (!has(indices.mapping)) added_.push_back(mapping(direction, indices.mapping, number));
    }
  }

  void finish() {
    std::vector<Object>& objects = device_.objects;
    objects.insert(objects.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
    std::ranges::sort(objects, {}, &Object::index);
  }

 private:
  [[nodiscard]] bool has(std::uint16_t index) const { return device_.find(index) != nullptr; }

  [[nodiscard]] bool has_one_of(const PdoParameterIndices& indices) const {
    return has(indices.communication) || has(indices.mapping);
  }

  [[nodiscard]] std::uint32_t count_described(const Direction& direction) const {
    std::uint32_t described = 0;
    for (std::uint16_t number = 1; number <= classical_can.pdos; ++number) {
      described += has_one_of(parameters_of(direction.direction, number)) ? 1 : 0;
    }
    return described;
  }

  [[nodiscard]] Object record(std::uint16_t index, std::string name) const {
    Object object;
    object.index = index;
    object.type = ObjectType::record;
    object.name = std::move(name);
    object.position = position_;
    return object;
  }

  Entry& add_entry(Object& object, std::uint32_t sub_index, std::string name, DataType type, Access access) const {
    Entry& entry = object.entries.emplace_back();
    entry.index = object.index;
    entry.sub_index = static_cast<std::uint8_t>(sub_index);
    entry.name = std::move(name);
    entry.type = canopen::find_data_type(static_cast<std::uint32_t>(type));
    entry.access = access;
    entry.position = entry.access_position = entry.mapping_position = position_;
    return entry;
  }

  [[nodiscard]] Value value(std::uint32_t bits) const { return {.bits = bits, .position = position_}; }

  [[nodiscard]] Object communication(const Direction& direction, std::uint16_t index, std::uint16_t number) const {
    Object object = record(index, fmt::format("{} communication parameter {}", direction.name, number));
    add_entry(object, 0, "Highest sub-index supported", DataType::unsigned8, Access::constant);
    std::uint8_t sub_index = 0;
    for (const CommunicationSub& row : communication_subs) {
      ++sub_index;
      if ((mask_ >> (sub_index - 1U) & 1U) == 0) continue;
      const CobIdParameter* const cob_id = find_cob_id_parameter(object.index, sub_index);
      Entry& entry =
          add_entry(object, sub_index,
                    cob_id != nullptr ? fmt::format("{} used by {}", row.name, direction.name) : std::string{row.name},
                    row.type, Access::rw);
      if (cob_id != nullptr) entry.default_value = predefined_cob_id(*cob_id, object.index, device_.node_id, position_);
      if (row.name == transmission_type) entry.default_value = value(default_transmission_type);
    }
    object.entries.front().default_value = value(object.entries.back().sub_index);
    return object;
  }

  [[nodiscard]] Object mapping(const Direction& direction, std::uint16_t index, std::uint16_t number) const {
    Object object = record(index, fmt::format("{} mapping parameter {}", direction.name, number));
    object.entries.reserve(classical_can.objects + 1U);
    add_entry(object, 0, "Number of mapped objects", DataType::unsigned8, Access::rw).default_value = value(0);
    for (std::uint32_t sub_index = 1; sub_index <= classical_can.objects; ++sub_index) {
      add_entry(object, sub_index, fmt::format("Mapped object {}", sub_index), DataType::unsigned32, Access::rw)
          .default_value = value(0);
    }
    return object;
  }

  std::uint32_t mask_;
  Position position_;
  Device& device_;
  std::vector<Object> added_;
};

}  // namespace

void add_compact_pdos(const DeviceInfo& info, Device& device, Diagnostics& diagnostics) {
  const std::uint32_t mask = device.information.capabilities.compact_pdo.value_or(0);
  if (mask == 0) return;
  if ((mask & ~known_bits) != 0) {
    diagnostics.warning("compact-pdo", info.compact_pdo.position,
                        "CompactPDO has bits for sub-indices that a communication parameter cannot have");
  }
  CompactPdos compact{mask & known_bits, info.compact_pdo.position, device};
  for (const Direction& direction : directions) {
    const bool receive = direction.count == &DeviceInfo::nr_of_rx_pdo;
    const Capabilities& capabilities = device.information.capabilities;
    const std::uint32_t count = (receive ? capabilities.nr_of_rx_pdo : capabilities.nr_of_tx_pdo).value_or(0);
    if (count > classical_can.pdos) {
      diagnostics.warning("compact-pdo", (info.*direction.count).position,
                          fmt::format("a device can have at most {} PDOs per direction", classical_can.pdos));
    }
    compact.add(direction, std::min<std::uint32_t>(count, classical_can.pdos));
  }
  compact.finish();
}

}  // namespace edsc
