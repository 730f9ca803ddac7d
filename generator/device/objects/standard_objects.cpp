#include "device/objects/standard_objects.hpp"

#include <algorithm>
#include <iterator>

namespace edsc {

const StandardObject* find_standard_object(std::uint16_t index) {
  const auto at = std::ranges::lower_bound(standard::objects, index, {}, &StandardObject::last);
  return at != std::end(standard::objects) && at->first <= index ? &*at : nullptr;
}

const StandardEntry* find_standard_entry(const StandardObject& object, std::uint8_t sub_index) {
  const auto at = std::ranges::find_if(
      object.entries, [&](const StandardEntry& entry) { return sub_index >= entry.first && sub_index <= entry.last; });
  return at == object.entries.end() ? nullptr : &*at;
}

const StandardEntry* find_standard_entry(std::uint16_t index, std::uint8_t sub_index) {
  const StandardObject* const object = find_standard_object(index);
  return object == nullptr ? nullptr : find_standard_entry(*object, sub_index);
}

}  // namespace edsc
