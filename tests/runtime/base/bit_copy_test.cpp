#include <gtest/gtest.h>
#include <canopen/base/bit_copy.hpp>

#include <array>
#include <cstdint>

namespace {

using Data = std::array<std::uint8_t, 8>;

constexpr Data put(Data data, unsigned at, unsigned bits, std::uint64_t value) {
  canopen::put_bits(data.data(), at, bits, value);
  return data;
}

TEST(BitCopy, PutsTheLowestBitFirst) {
  EXPECT_EQ(put({}, 0, 16, 0x1234), (Data{0x34, 0x12}));
  EXPECT_EQ(put({}, 4, 12, 0xABC), (Data{0xC0, 0xAB}));
  EXPECT_EQ(put({}, 31, 33, 0x1'0000'0001), (Data{0, 0, 0, 0x80, 0, 0, 0, 0x80}));
}

TEST(BitCopy, LeavesTheBitsBesideTheValueAlone) {
  constexpr Data ones{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(put(ones, 3, 10, 0), (Data{0x07, 0xE0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(put({}, 3, 10, ~std::uint64_t{0}), (Data{0xF8, 0x1F}));
}

TEST(BitCopy, PutsNothingOfNoBits) { EXPECT_EQ(put({0x55}, 3, 0, ~std::uint64_t{0}), (Data{0x55})); }

TEST(BitCopy, TakesNothingBeyondTheValue) {
  constexpr Data data{0xFF, 0x34, 0x12, 0xFF};
  EXPECT_EQ(canopen::take_bits(data.data(), 8, 16), 0x1234U);
  EXPECT_EQ(canopen::take_bits(data.data(), 12, 8), 0x23U);
  EXPECT_EQ(canopen::take_bits(data.data(), 12, 0), 0U);
}

TEST(BitCopy, IsKnownWhileTheProgramIsCompiled) {
  static_assert(put({}, 7, 2, 3) == Data{0x80, 0x01});
  static_assert(canopen::take_bits(Data{0x80, 0x01}.data(), 7, 2) == 3);
}

/// Compares each length at each bit position with bits that are counted one by one.
TEST(BitCopy, PutsAndTakesEveryLengthAtEveryBit) {
  constexpr std::uint64_t value = 0x9E37'79B9'7F4A'7C15;
  constexpr Data before{0xA5, 0x5A, 0xC3, 0x3C, 0x96, 0x69, 0x0F, 0xF0};
  for (unsigned at = 0; at < 64; ++at) {
    for (unsigned bits = 0; at + bits <= 64; ++bits) {
      const Data data = put(before, at, bits, value);
      std::uint64_t expected = 0;
      for (unsigned bit = 0; bit < 64; ++bit) {
        const bool inside = bit >= at && bit < at + bits;
        const std::uint64_t of_value = inside ? (value >> (bit - at)) & 1u : (before[bit / 8] >> (bit % 8)) & 1u;
        ASSERT_EQ((data[bit / 8] >> (bit % 8)) & 1u, of_value) << at << " " << bits << " " << bit;
        if (inside) expected |= of_value << (bit - at);
      }
      ASSERT_EQ(canopen::take_bits(data.data(), at, bits), expected) << at << " " << bits;
    }
  }
}

}  // namespace
