#include "backend/cpp/cpp_names.hpp"

#include <fmt/format.h>

#include "backend/cpp/identifier.hpp"
#include "backend/cpp/placement.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// The name in the options, else from ParameterName, else from the index.
std::string identifier(const Options& options, std::string_view name, std::uint16_t index, std::uint8_t sub_index) {
  if (const auto at = options.names.find({index, sub_index}); at != options.names.end()) return at->second;
  std::string made = to_snake_case(name);
  if (made.empty()) made = sub_index == 0 ? fmt::format("object_{:04x}", index) : fmt::format("sub_{:02x}", sub_index);
  return made;
}

}  // namespace

CppNames::CppNames(const Device& device, const Options& options, std::string_view space)
    : space_{space.empty() ? to_namespace(stem_of(device.source->name())) : std::string{space}} {
  IdentifierScope scope;
  for (const Object& object : device.objects) {
    const std::string& name = objects_[object.index] =
        scope.take(identifier(options, object.name, object.index, 0), fmt::format("{:04x}", object.index));
    if (object.has_sub_indices()) {
      name_entries(object, options);
    } else {
      entries_[key_of(object.entries.front())] = name;
    }
  }
}

void CppNames::name_entries(const Object& object, const Options& options) {
  IdentifierScope scope;
  for (const Entry& entry : object.entries) {
    const bool has_own_name = entry.sub_index != 0 || entry.name != object.name;
    entries_[key_of(entry)] = scope.take(has_own_name ? identifier(options, entry.name, entry.index, entry.sub_index)
                                                      : std::string{"highest_sub_index_supported"},
                                         fmt::format("{:02x}", entry.sub_index));
  }
}

std::string CppNames::type_of(const Object& object, const Entry& entry) const {
  if (!object.has_sub_indices()) return fmt::format("od::{}", of(object));
  if (describes_uniform_array(object)) return fmt::format("od::{}<{}>", of(object), entry.sub_index);
  return fmt::format("od::{}::{}", of(object), of(entry));
}

}  // namespace edsc
