#include <gtest/gtest.h>
#include <canopen/pdo.hpp>

#include <array>
#include <cstdint>

#include <sample/pdo.hpp>

namespace {

using canopen::Access;
using canopen::Mappable;
using Data = std::array<std::uint8_t, 8>;
namespace od = sample::od;

template <std::uint8_t SubIndex, class T, std::uint16_t Bits>
using Entry = canopen::Object<0x3000, SubIndex, T, Access::rw, Mappable::both, Bits>;

TEST(PdoLayout, PutsTheFirstObjectIntoTheLowestBits) {
  EXPECT_EQ(sample::Tpdo1::pack(0x0231, 0x12345678), (Data{0x31, 0x02, 0x78, 0x56, 0x34, 0x12}));
}

TEST(PdoLayout, KnowsItsLength) {
  EXPECT_EQ(sample::Tpdo1::bits, 48u);
  EXPECT_EQ(sample::Tpdo1::size, 6);
  EXPECT_EQ(sample::Tpdo2::bits, 50u);
  EXPECT_EQ(sample::Tpdo2::size, 7);
  EXPECT_EQ(sample::Rpdo2::offsets, (std::array{0u, 1u, 2u, 10u, 34u}));
}

TEST(PdoLayout, IsKnownWhileTheProgramIsCompiled) {
  static_assert(sample::Tpdo1::pack(0x0231, -1) == Data{0x31, 0x02, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0});
  static_assert(sample::Tpdo1::get<1>(Data{0, 0, 0xFE, 0xFF, 0xFF, 0xFF, 0, 0}) == -2);
}

TEST(PdoLayout, UnpacksWhatItPacks) {
  const auto data = sample::Tpdo2::pack(true, false, -2, 0x81);
  EXPECT_EQ(data, (Data{0xF9, 0xFF, 0xFF, 0xFF, 0xFF, 0x07, 0x02}));
  EXPECT_EQ(sample::Tpdo2::unpack(data), std::make_tuple(true, false, std::int64_t{-2}, std::uint8_t{0x81}));
}

TEST(PdoLayout, TellsWhichObjectsItMaps) {
  static_assert(sample::Tpdo1::maps<od::statusword>);
  static_assert(!sample::Tpdo1::maps<od::controlword>);
}

TEST(PdoLayout, MayStraddleNineBytesOfShiftedBits) {
  // 1 bit and 63 bits: the long one touches all eight bytes.
  using Layout = canopen::PdoLayout<Entry<1, bool, 1>, Entry<2, std::uint64_t, 63>>;
  const auto data = Layout::pack(true, 0x4000'0000'0000'0001);
  EXPECT_EQ(data, (Data{0x03, 0, 0, 0, 0, 0, 0, 0x80}));
  EXPECT_EQ(Layout::get<1>(data), 0x4000'0000'0000'0001u);
}

TEST(PdoLayout, CutsAValueToItsBits) {
  using Layout = canopen::PdoLayout<Entry<1, std::uint8_t, 4>, Entry<2, std::uint8_t, 4>>;
  EXPECT_EQ(Layout::pack(0xFF, 0), (Data{0x0F}));
}

/// Every length at every first bit, signed, against bits counted one by one.
template <unsigned First, unsigned Length>
void check_place() {
  const std::uint64_t value = 0x9E37'79B9'7F4A'7C15u & canopen::pdo_detail::mask(Length);
  Data data{};
  canopen::pdo_detail::put<First, Length>(data, value);
  for (unsigned bit = 0; bit < 64; ++bit) {
    const bool inside = bit >= First && bit < First + Length;
    const unsigned expected = inside ? static_cast<unsigned>(value >> (bit - First)) & 1u : 0u;
    ASSERT_EQ((data.at(bit / 8) >> (bit % 8)) & 1u, expected) << First << " " << Length << " " << bit;
  }
  for (auto& byte : data) byte = static_cast<std::uint8_t>(~byte);
  ASSERT_EQ((canopen::pdo_detail::take<First, Length>(data)), ~value & canopen::pdo_detail::mask(Length));
}

template <unsigned First, unsigned... Length>
void check_lengths(std::integer_sequence<unsigned, Length...>) {
  (check_place<First, Length + 1>(), ...);
}

TEST(PdoLayout, PutsEveryLengthAtEveryBit) {
  [&]<unsigned... First>(std::integer_sequence<unsigned, First...>) {
    (check_lengths<First>(std::make_integer_sequence<unsigned, 64 - First>{}), ...);
  }
  (std::make_integer_sequence<unsigned, 64>{});
}

TEST(PdoLayout, CarriesRealsAndTimes) {
  using Layout = canopen::PdoLayout<Entry<1, float, 32>>;
  EXPECT_EQ(Layout::pack(1.5f), (Data{0x00, 0x00, 0xC0, 0x3F}));
  EXPECT_EQ(Layout::get<0>(Data{0x00, 0x00, 0xC0, 0x3F}), 1.5f);
  using Time = canopen::PdoLayout<Entry<1, canopen::TimeOfDay, 48>>;
  EXPECT_EQ(Time::pack({0x0ABCDEF0, 0x1234}), (Data{0xF0, 0xDE, 0xBC, 0x0A, 0x34, 0x12}));
  EXPECT_EQ(Time::get<0>(Data{0xF0, 0xDE, 0xBC, 0x0A, 0x34, 0x12}), (canopen::TimeOfDay{0x0ABCDEF0, 0x1234}));
}

}  // namespace
