#include <gtest/gtest.h>
#include <canopen/base/crc16.hpp>

#include <cstdint>
#include <string>

namespace {

TEST(Crc16, IsThatOfCia301) {
  std::uint16_t crc = 0;
  for (const char digit : std::string{"123456789"}) crc = canopen::crc16_ccitt(crc, static_cast<std::uint8_t>(digit));
  EXPECT_EQ(crc, 0x31C3);
  static_assert(canopen::crc16_ccitt(0, 0) == 0);
  static_assert(canopen::crc16_ccitt(0, 1) == 0x1021);
  static_assert(canopen::crc16_ccitt(0, 0x80) == 0x9188);
}

TEST(Crc16, TakesTwoBytesAsOneAfterTheOther) {
  for (std::uint32_t crc = 0; crc <= 0xFFFF; crc += 0x0101) {
    for (std::uint32_t bytes = 0; bytes <= 0xFFFF; bytes += 0x00FD) {
      const auto before = static_cast<std::uint16_t>(crc);
      const auto first = static_cast<std::uint8_t>(bytes >> 8);
      const auto second = static_cast<std::uint8_t>(bytes & 0xFF);
      ASSERT_EQ(canopen::crc16_ccitt(before, first, second),
                canopen::crc16_ccitt(canopen::crc16_ccitt(before, first), second));
    }
  }
}

}  // namespace
