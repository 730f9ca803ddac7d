#include "device/bit_rates.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace edsc {
namespace {

TEST(BitRates, AreThoseOfCia301InAscendingOrder) {
  EXPECT_EQ(bit_rates, (std::array<std::uint16_t, 8>{10, 20, 50, 125, 250, 500, 800, 1000}));
}

/// The reserved index of table 0 is not a bit rate.
TEST(BitRates, DoNotHaveAReservedOne) {
  EXPECT_TRUE(is_bit_rate(800));
  EXPECT_FALSE(is_bit_rate(0));
  EXPECT_FALSE(is_bit_rate(100));
}

}  // namespace
}  // namespace edsc
