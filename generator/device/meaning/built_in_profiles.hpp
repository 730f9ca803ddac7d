/// The files of generator/profiles. The build writes the definition.
#pragma once

#include <span>
#include <string_view>

namespace edsc {

struct BuiltInProfile {
  std::string_view name, text;
};

[[nodiscard]] std::span<const BuiltInProfile> built_in_profiles();

}  // namespace edsc
