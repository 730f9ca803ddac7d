/// Objects that a device profile requires. What it says about each object is in generator/profiles.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "rules/check_rules.hpp"

namespace edsc {

/// A device of the profile has one of these objects.
struct ProfileNeed {
  AnyRule rule;
  std::uint16_t profile;
  std::array<std::uint16_t, 3> one_of;  ///< unused elements are 0
  std::string_view name;
};

inline constexpr ProfileNeed profile_needs[] = {
    {"profile-402-object", 402, {0x6040}, "controlword"},
    {"profile-402-object", 402, {0x6041}, "statusword"},
    {"profile-402-object", 402, {0x6060}, "modes of operation"},
    {"profile-402-object", 402, {0x6061}, "modes of operation display"},
    {"profile-402-modes", 402, {0x6502}, "supported drive modes"},
    {"profile-406-object", 406, {0x6000}, "operating parameters"},
    {"profile-406-object", 406, {0x6004, 0x6020, 0x6008}, "position value"},
    {"profile-406-object", 406, {0x6500}, "operating status"},
};

}  // namespace edsc
