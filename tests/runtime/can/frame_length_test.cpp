#include <canopen/can/frame_length.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <string>

namespace canopen {
namespace {

void append(std::string& bits, std::uint32_t value, int count) {
  while (count-- > 0) bits += ((value >> count) & 1U) != 0 ? '1' : '0';
}

/// The bits from start of frame to the end of the CRC (ISO 11898-1): those that are stuffed.
std::string stuffed_part(const Frame& frame) {
  std::string bits = "0";
  if (frame.extended) {
    append(bits, frame.id >> 18, 11);
    bits += "11";  // SRR, IDE
    append(bits, frame.id & 0x3FFFF, 18);
    bits += frame.remote ? "100" : "000";  // RTR, r1, r0
  } else {
    append(bits, frame.id, 11);
    bits += frame.remote ? "100" : "000";  // RTR, IDE, r0
  }
  append(bits, frame.size, 4);
  for (std::uint8_t i = 0; !frame.remote && i < frame.size; ++i) append(bits, frame.data[i], 8);
  std::uint32_t crc = 0;
  for (const char bit : bits) {
    const bool high = ((crc >> 14) & 1U) != (bit == '1' ? 1U : 0U);
    crc = (crc << 1) & 0x7FFF;
    if (high) crc ^= 0x4599;
  }
  append(bits, crc, 15);
  return bits;
}

/// The length after a bit of opposite level is inserted after five equal ones.
std::size_t length_with_stuff_bits(const std::string& bits) {
  std::size_t length = 0;
  std::size_t equal = 0;
  char last = 'x';
  for (const char bit : bits) {
    equal = bit == last ? equal + 1 : 1;
    last = bit;
    ++length;
    if (equal == 5) {
      ++length;
      last = bit == '0' ? '1' : '0';
      equal = 1;
    }
  }
  return length;
}

constexpr std::size_t not_stuffed = 1 + 2 + 7 + 3;  // CRC delimiter, ACK, end of frame, intermission

TEST(FrameLength, WithoutStuffBitsIncludesTheIntermission) {
  EXPECT_EQ(bits_on_wire({}), 47U);
  EXPECT_EQ(bits_on_wire({.size = 8}), 111U);
  EXPECT_EQ(bits_on_wire({.size = 8, .remote = true}), 47U);
  EXPECT_EQ(bits_on_wire({.size = 8, .extended = true}), 131U);
}

/// 55 + 10 n bits with 11-bit identifiers, 80 + 10 n with 29-bit ones (Davis et al. 2007).
TEST(FrameLength, WithAllStuffBitsIsThatOfTheLiterature) {
  for (std::uint8_t size = 0; size <= 8; ++size) {
    EXPECT_EQ(max_bits_on_wire({.size = size}), 55U + 10U * size);
    EXPECT_EQ(max_bits_on_wire({.size = size, .extended = true}), 80U + 10U * size);
  }
  EXPECT_EQ(max_bits_on_wire({.size = 8, .remote = true}), 55U);
  EXPECT_EQ(max_bits_on_wire({.size = 8, .extended = true, .remote = true}), 80U);
}

TEST(FrameLength, WithAllStuffBitsIsReachedByTheWorstBits) {
  std::string bits = "00000";
  while (bits.size() < 54 + 64) bits += bits.back() == '0' ? "1111" : "0000";
  EXPECT_EQ(length_with_stuff_bits(bits.substr(0, 34 + 64)) + not_stuffed, max_bits_on_wire({.size = 8}));
  EXPECT_EQ(length_with_stuff_bits(bits.substr(0, 54 + 64)) + not_stuffed,
            max_bits_on_wire({.size = 8, .extended = true}));
}

/// Counted by hand. CAN-ID 0 without data: 19 zeros and a CRC of 15 zeros, with a stuff bit after each five of these
/// 34. CAN-ID 555h of a remote frame with data length 5: no five equal bits before the CRC, which has 15.
TEST(FrameLength, WithTheStuffBitsOfTheContents) {
  EXPECT_EQ(stuffed_bits_on_wire({}), 47U + 6U);
  EXPECT_EQ(stuffed_bits_on_wire({.data = {0xFF}}), 47U + 6U);
  EXPECT_LE(stuffed_bits_on_wire({.id = 0x555, .size = 5, .remote = true}), 47U + 3U);
}

TEST(FrameLength, OfEncodedFramesIsWithinTheLimits) {
  std::minstd_rand random{11898};
  std::size_t max_stuff_bits = 0;
  for (int i = 0; i < 20'000; ++i) {
    Frame frame{
        .size = static_cast<std::uint8_t>(random() % 9), .extended = random() % 2 == 0, .remote = random() % 8 == 0};
    frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? 0x1FFF'FFFF : 0x7FF);
    // Few different bytes, so that long runs of equal bits are common.
    for (std::uint8_t& byte : frame.data) byte = random() % 4 == 0 ? static_cast<std::uint8_t>(random()) : 0x00;
    if (random() % 4 == 0) frame.id = 0;
    const std::string bits = stuffed_part(frame);
    const std::size_t length = length_with_stuff_bits(bits) + not_stuffed;
    ASSERT_EQ(bits.size() + not_stuffed, bits_on_wire(frame));
    ASSERT_LE(length, max_bits_on_wire(frame));
    ASSERT_EQ(length, stuffed_bits_on_wire(frame));
    max_stuff_bits = std::max(max_stuff_bits, length - bits_on_wire(frame));
  }
  EXPECT_GE(max_stuff_bits, 15U);
}

}  // namespace
}  // namespace canopen
