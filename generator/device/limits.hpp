/// Limits of a device (CiA 301, 7.4 and 7.5.2).
#pragma once

#include <cstdint>

namespace edsc {

inline constexpr std::uint16_t max_pdos = 512;  ///< per direction
inline constexpr std::uint8_t max_mapped_objects = 64;
inline constexpr std::uint8_t max_sub_objects = 254;

}  // namespace edsc
