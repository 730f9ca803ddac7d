/// Order of two frames in CAN arbitration.
#pragma once

#include <cstdint>

#include "canopen/can/frame.hpp"

namespace canopen {

/// Returns the value that arbitration compares (ISO 11898-1); the lowest is the most dominant: a base frame wins over
/// an extended one with the same first 11 bits, a data frame over a remote one.
[[nodiscard]] constexpr std::uint64_t arbitration_value(const Frame& frame) {
  const std::uint64_t base = frame.extended ? frame.id >> 18 : frame.id;
  const std::uint64_t rest = frame.extended ? frame.id & 0x3FFFF : 0;
  return (base << 21) | (std::uint64_t{frame.extended} << 20) | (rest << 1) | std::uint64_t{frame.remote};
}

}  // namespace canopen
