/// Limits of PDOs.
#pragma once

#include <cstdint>

namespace edsc {

/// What PDOs in one kind of frame can have.
struct PdoLimits {
  unsigned bytes;        ///< of data in a frame
  std::uint8_t objects;  ///< that a PDO maps
  std::uint16_t pdos;    ///< of a device, in each direction

  [[nodiscard]] constexpr unsigned bits() const { return 8 * bytes; }
};

/// In classical CAN frames (CiA 301, 7.5.2.35 to 7.5.2.38).
inline constexpr PdoLimits classical_can{.bytes = 8, .objects = 64, .pdos = 512};

}  // namespace edsc
