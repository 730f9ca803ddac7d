#include "backend/cpp/cpp_names.hpp"

#include <fmt/format.h>

#include "backend/cpp/identifier.hpp"
#include "device/uniform_array.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"

namespace edsc {

CppNames::CppNames(const Device& device, const Options& options, std::string_view space)
    : identifiers_{device, options, space},
      space_{space.empty() ? to_namespace(stem_of(device.source->name())) : std::string{space}} {}

std::string CppNames::of(const Object& object) const { return without_reserved_word(identifiers_.of(object)); }

std::string CppNames::of(const Entry& entry) const { return without_reserved_word(identifiers_.of(entry)); }

CppType CppNames::type_of(const Object& object, const Entry& entry) const {
  if (!object.has_sub_indices()) return {fmt::format("od::{}", of(object)), ""};
  if (const std::string* const own = identifiers_.element(entry)) return {"od::" + without_reserved_word(*own), ""};
  if (describes_uniform_array(object)) return {fmt::format("od::{}<{}>", of(object), entry.sub_index), ""};
  return {fmt::format("od::{}", of(object)), fmt::format("::{}", of(entry))};
}

}  // namespace edsc
