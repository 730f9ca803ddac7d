/// Length of frames on the wire.
#pragma once

#include <cstdint>

#include "canopen/can/frame.hpp"

namespace canopen {

/// Returns the bits of a frame on the wire without stuff bits, from start of frame to the end of the intermission
/// (ISO 11898-1): 47 bits of an 11-bit frame and 67 of a 29-bit one include the 3 bits of the intermission. A remote
/// frame has no data bits, whatever its size.
[[nodiscard]] constexpr std::uint32_t bits_on_wire(const Frame& frame) {
  const std::uint32_t data = frame.remote ? 0u : 8u * frame.size;
  return (frame.extended ? 67u : 47u) + data;
}

/// Returns the bits of a frame with the largest number of stuff bits that a frame of this format and size can have.
/// The last 13 bits, from the CRC delimiter to the end of the intermission, are not stuffed. In the n bits before, the
/// first stuff bit follows five equal bits, and each other one at least four bits later: (n - 1) / 4 of them. Between
/// 55 and 160 bits.
[[nodiscard]] constexpr std::uint32_t max_bits_on_wire(const Frame& frame) {
  constexpr std::uint32_t not_stuffed = 13;
  const std::uint32_t bits = bits_on_wire(frame);
  return bits + (bits - not_stuffed - 1) / 4;
}

}  // namespace canopen
