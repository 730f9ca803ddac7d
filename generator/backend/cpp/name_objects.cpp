#include "backend/cpp/name_objects.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "backend/cpp/identifier.hpp"
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

void name_entries(Object& object, const Options& options) {
  IdentifierScope scope;
  for (Entry& entry : object.entries) {
    const bool has_own_name = entry.sub_index != 0 || entry.name != object.name;
    entry.identifier = scope.take(has_own_name ? identifier(options, entry.name, entry.index, entry.sub_index)
                                               : std::string{"highest_sub_index_supported"},
                                  fmt::format("{:02x}", entry.sub_index));
  }
}

}  // namespace

void name_objects(Device& device, const Options& options, const std::string& name) {
  device.name = name.empty() ? to_namespace(std::filesystem::path{device.source->name()}.stem().string()) : name;
  IdentifierScope scope;
  for (Object& object : device.objects) {
    object.identifier =
        scope.take(identifier(options, object.name, object.index, 0), fmt::format("{:04x}", object.index));
    if (object.has_sub_indices()) {
      name_entries(object, options);
    } else {
      object.entries.front().identifier = object.identifier;
    }
  }
}

}  // namespace edsc
