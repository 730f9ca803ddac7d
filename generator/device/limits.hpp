/// Limits of a device (CiA 301, 7.4). Those of PDOs are in pdo/limits.hpp.
#pragma once

#include <cstddef>
#include <cstdint>

namespace edsc {

inline constexpr std::uint8_t max_sub_objects = 254;

/// Of a device that edsc resolves: an EDS of 1 MB in compact form, or with modules, can describe millions.
inline constexpr std::size_t max_entries = 0x20000;

}  // namespace edsc
