/// Length of frames on the wire: without stuff bits, with the largest number of them, and with those of the contents.
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

namespace frame_length_detail {

/// Counts the stuff bits of a bit sequence, and computes its CRC (ISO 11898-1, 10.4.2.6).
class StuffedBits {
 public:
  /// Appends the low `count` bits of a number, most significant first.
  constexpr void add(std::uint32_t number, unsigned count) {
    for (unsigned i = count; i-- > 0;) {
      const std::uint32_t bit = (number >> i) & 1u;
      crc_ = (crc_ << 1) ^ ((((crc_ >> 14) ^ bit) & 1u) * polynomial);
      stuff(bit);
    }
  }

  /// Appends the CRC sequence of all bits before.
  constexpr void add_crc() { add(crc_ & 0x7FFF, 15); }

  /// Returns the number of stuff bits.
  [[nodiscard]] constexpr std::uint32_t count() const { return count_; }

 private:
  static constexpr std::uint32_t polynomial = 0x4599;

  /// After five equal bits, a complementary one follows, which is the first of the next sequence.
  constexpr void stuff(std::uint32_t bit) {
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < 5) return;
    ++count_;
    last_ ^= 1u;
    run_ = 1;
  }

  std::uint32_t crc_ = 0;
  std::uint32_t last_ = 2;  ///< no bit yet
  std::uint32_t run_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace frame_length_detail

/// Returns the bits of this frame on the wire with the stuff bits that its identifier, data and CRC need, from start of
/// frame to the end of the intermission: between `bits_on_wire` and `max_bits_on_wire`.
[[nodiscard]] constexpr std::uint32_t stuffed_bits_on_wire(const Frame& frame) {
  frame_length_detail::StuffedBits bits;
  bits.add(0, 1);  // start of frame
  if (frame.extended) {
    bits.add(frame.id >> 18, 11);
    bits.add(0b11, 2);  // SRR, IDE
    bits.add(frame.id, 18);
    bits.add(frame.remote ? 0b100 : 0b000, 3);  // RTR, two reserved bits
  } else {
    bits.add(frame.id, 11);
    bits.add(frame.remote ? 0b100 : 0b000, 3);  // RTR, IDE, a reserved bit
  }
  bits.add(frame.size, 4);
  for (std::uint32_t i = 0; i < frame.size && !frame.remote; ++i) bits.add(frame.data[i], 8);
  bits.add_crc();
  return bits_on_wire(frame) + bits.count();
}

}  // namespace canopen
