#include "pdo/mapping.hpp"

#include <canopen/pdo/pdo_mapping.hpp>

namespace edsc {
namespace {

/// Sets the offset of each object: the end of the object before it.
void place(std::vector<PlacedObject>& objects) {
  unsigned end = 0;
  for (PlacedObject& object : objects) {
    object.offset = static_cast<std::uint16_t>(end);
    end = object.end();
  }
}

}  // namespace

PdoParameterIndices parameters_of(PdoDirection direction, std::uint16_t number) {
  const canopen::PdoIndices& first = direction == PdoDirection::receive ? canopen::rpdo_indices : canopen::tpdo_indices;
  const auto offset = static_cast<std::uint16_t>(number - 1);
  return {static_cast<std::uint16_t>(first.communication + offset), static_cast<std::uint16_t>(first.mapping + offset)};
}

std::uint16_t mapping_parameter_of(std::uint16_t communication) {
  constexpr std::uint16_t distance = canopen::rpdo_indices.mapping - canopen::rpdo_indices.communication;
  return static_cast<std::uint16_t>(communication + distance);
}

bool is_multiplexed(std::uint64_t count) { return count >= canopen::source_multiplexed; }

MappingValue MappingValue::of(std::uint32_t value) {
  const canopen::MappedObject mapped{value};
  return {mapped.index(), mapped.sub_index(), mapped.bits()};
}

std::uint32_t MappingValue::value() const {
  return std::uint32_t{index} << 16 | std::uint32_t{sub_index} << 8 | std::uint32_t{bits};
}

bool MappingValue::is_dummy() const { return canopen::MappedObject{value()}.is_dummy(); }

const canopen::DataTypeRow* MappingValue::dummy_type() const {
  return is_dummy() ? canopen::find_data_type(index) : nullptr;
}

std::vector<PlacedObject> placed(std::span<const MappingValue> objects) {
  std::vector<PlacedObject> result;
  result.reserve(objects.size());
  std::uint8_t position = 0;
  for (const MappingValue& object : objects) result.push_back({object, ++position});
  place(result);
  return result;
}

std::vector<PlacedObject> read_mapping(std::uint8_t count, const std::function<std::uint32_t(std::uint8_t)>& value_of) {
  std::vector<PlacedObject> result;
  for (unsigned i = 1; i <= count; ++i) {
    const auto position = static_cast<std::uint8_t>(i);
    const MappingValue object = MappingValue::of(value_of(position));
    if (!object.is_empty()) result.push_back({object, position});
  }
  place(result);
  return result;
}

}  // namespace edsc
