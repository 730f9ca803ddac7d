#include "device/device.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>

namespace edsc {

std::string_view to_string(ObjectType type) {
  switch (type) {
    case ObjectType::null: return "NULL";
    case ObjectType::domain: return "DOMAIN";
    case ObjectType::deftype: return "DEFTYPE";
    case ObjectType::defstruct: return "DEFSTRUCT";
    case ObjectType::var: return "VAR";
    case ObjectType::array: return "ARRAY";
    case ObjectType::record: return "RECORD";
  }
  return "?";
}

const Entry* Object::find(std::uint8_t sub_index) const {
  const auto at = std::ranges::lower_bound(entries, sub_index, {}, &Entry::sub_index);
  return at != entries.end() && at->sub_index == sub_index ? &*at : nullptr;
}

std::uint8_t Object::highest_sub_index() const {
  constexpr std::uint8_t structure = 0xFF;
  const auto last =
      std::find_if(entries.rbegin(), entries.rend(), [](const Entry& entry) { return entry.sub_index != structure; });
  return last != entries.rend() ? last->sub_index : 0;
}

const Object* Device::find(std::uint16_t index) const {
  const auto at = std::ranges::lower_bound(objects, index, {}, &Object::index);
  return at != objects.end() && at->index == index ? &*at : nullptr;
}

const Entry* Device::find(std::uint16_t index, std::uint8_t sub_index) const {
  const Object* object = find(index);
  return object == nullptr ? nullptr : object->find(sub_index);
}

Position default_place(const Entry& entry) {
  return entry.default_value ? entry.default_value->position : entry.position;
}

std::string entry_label(std::uint16_t index, std::uint8_t sub_index) {
  return fmt::format(FMT_COMPILE("{:04X}h:{:02X}"), index, sub_index);
}

std::string index_label(std::uint16_t index) { return fmt::format(FMT_COMPILE("{:04X}h"), index); }

std::string named(const Entry& entry) {
  return fmt::format("{} \"{}\"", entry_label(entry.index, entry.sub_index), entry.name);
}

std::string named(const Object& object) { return fmt::format("{} \"{}\"", index_label(object.index), object.name); }

std::string pdo_label(const Pdo& pdo) {
  return fmt::format("{} {}", pdo.direction == PdoDirection::receive ? "RPDO" : "TPDO", pdo.number);
}

}  // namespace edsc
