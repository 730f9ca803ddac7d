/// The files of generator/profiles. The build writes the definition.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace edsc {

struct BuiltInProfile {
  std::uint16_t number = 0;  ///< of its member `profile`
  std::string_view name, text;
};

[[nodiscard]] std::span<const BuiltInProfile> built_in_profiles();

}  // namespace edsc
