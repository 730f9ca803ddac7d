#include "device/uniform_array.hpp"

#include <cstddef>
#include <optional>

namespace edsc {

bool describes_uniform_array(const Object& object) {
  if (object.type != ObjectType::array || object.entries.size() < 2 || object.entries.front().sub_index != 0)
    return false;
  const Entry& first = object.entries[1];
  if (first.type->bits == 0) return false;
  const auto same = [](const std::optional<Value>& a, const std::optional<Value>& b) {
    return a.has_value() == b.has_value() && (!a || a->bits == b->bits);
  };
  for (std::size_t i = 1; i < object.entries.size(); ++i) {
    const Entry& entry = object.entries[i];
    if (entry.sub_index != i || entry.type != first.type || entry.access != first.access ||
        entry.pdo_mapping != first.pdo_mapping || !same(entry.low_limit, first.low_limit) ||
        !same(entry.high_limit, first.high_limit)) {
      return false;
    }
  }
  return true;
}

}  // namespace edsc
