#include "backend/identifiers.hpp"

#include <fmt/format.h>

#include "system/path.hpp"
#include "text/snake_case.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// From the name in the options, else from ParameterName, else from the index. A name in the options that C++ reserves
/// ends with an underscore, which is left out.
std::string identifier(const Options& options, std::string_view name, std::uint16_t index, std::uint8_t sub_index) {
  if (const auto at = options.names.find({index, sub_index}); at != options.names.end()) {
    return to_snake_case(at->second);
  }
  std::string made = to_snake_case(name);
  if (made.empty()) made = sub_index == 0 ? fmt::format("object_{:04x}", index) : fmt::format("sub_{:02x}", sub_index);
  return made;
}

std::string name_of_file(const Device& device) {
  std::string name = to_snake_case(stem_of(device.source->name()));
  return name.empty() ? "device" : name;
}

}  // namespace

std::string IdentifierScope::take(const std::string& wanted, std::string_view suffix) {
  if (taken_.insert(wanted).second) return wanted;
  std::string base = wanted;
  if (base.back() != '_') base += '_';
  base += suffix;
  std::string candidate = base;
  for (int i = 2; !taken_.insert(candidate).second; ++i) candidate = base + "_" + std::to_string(i);
  return candidate;
}

Identifiers::Identifiers(const Device& device, const Options& options, std::string_view device_name)
    : device_{device_name.empty() ? name_of_file(device) : std::string{device_name}} {
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

void Identifiers::name_entries(const Object& object, const Options& options) {
  IdentifierScope scope;
  for (const Entry& entry : object.entries) {
    const bool has_own_name = entry.sub_index != 0 || entry.name != object.name;
    entries_[key_of(entry)] = scope.take(has_own_name ? identifier(options, entry.name, entry.index, entry.sub_index)
                                                      : std::string{"highest_sub_index_supported"},
                                         fmt::format("{:02x}", entry.sub_index));
  }
}

}  // namespace edsc
