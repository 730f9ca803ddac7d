#include "device/objects/object_structure.hpp"

#include <fmt/format.h>

#include "device/index_range.hpp"

namespace edsc {
namespace {

/// Structures of CiA 301, table 44, used by objects of the communication profile.
struct StandardRecord {
  IndexRange objects;
  std::uint8_t data_type;
};

constexpr StandardRecord standard_records[] = {
    {{0x1018, 0x1018}, 0x23}, {{0x1200, 0x12FF}, 0x22}, {{0x1400, 0x15FF}, 0x20},
    {{0x1600, 0x17FF}, 0x21}, {{0x1800, 0x19FF}, 0x20}, {{0x1A00, 0x1BFF}, 0x21},
};

/// The data type of an ARRAY is that of its elements; that of a RECORD is known for some objects.
std::optional<std::uint8_t> data_type_of(const Object& object) {
  const Entry* first = object.find(1);
  if (object.type == ObjectType::array && first != nullptr && first->type != nullptr)
    return static_cast<std::uint8_t>(first->type->type);
  for (const StandardRecord& row : standard_records) {
    if (object.index >= row.objects.first && object.index <= row.objects.last) return row.data_type;
  }
  return std::nullopt;
}

}  // namespace

bool ObjectStructure::matches(std::uint64_t value) const {
  return (value & 0xFF) == object_code && (!data_type || (value >> 8 & 0xFF) == *data_type) && value >> 16 == 0;
}

std::string ObjectStructure::text() const {
  const std::string type = data_type ? fmt::format(" and data type {:02X}h", *data_type) : "";
  return fmt::format("object code {:02X}h{}", object_code, type);
}

ObjectStructure structure_of(const Object& object) {
  return {static_cast<std::uint8_t>(object.type), data_type_of(object)};
}

}  // namespace edsc
