#include "backend/cpp/cpp_name.hpp"

#include <fmt/format.h>

#include "backend/cpp/placement.hpp"

namespace edsc {

std::string cpp_name(const Object& object, const Entry& entry) {
  if (!object.has_sub_indices()) return fmt::format("od::{}", object.identifier);
  if (describes_uniform_array(object)) return fmt::format("od::{}<{}>", object.identifier, entry.sub_index);
  return fmt::format("od::{}::{}", object.identifier, entry.identifier);
}

}  // namespace edsc
