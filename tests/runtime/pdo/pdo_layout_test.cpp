#include <gtest/gtest.h>
#include <canopen/pdo/pdo.hpp>

#include <array>
#include <cstdint>

#include <sample/pdo.hpp>

namespace {

using canopen::Access;
using canopen::Mappable;
using Data = std::array<std::uint8_t, 8>;
namespace od = sample::od;

template <std::uint8_t SubIndex, class T, std::uint16_t Bits = canopen::wire_bits<T>>
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
  const auto data = sample::Tpdo2::pack(true, false, -2, canopen::raw(0x81));
  EXPECT_EQ(data, (Data{0xF9, 0xFF, 0xFF, 0xFF, 0xFF, 0x07, 0x02}));
  EXPECT_EQ(sample::Tpdo2::unpack(data),
            std::make_tuple(true, false, std::int64_t{-2}, od::error_register::type{canopen::raw(std::uint8_t{0x81})}));
}

TEST(PdoLayout, TellsWhichObjectsItMaps) {
  static_assert(sample::Tpdo1::maps<od::statusword>);
  static_assert(!sample::Tpdo1::maps<od::controlword>);
}

TEST(PdoLayout, MayStraddleAllBytesOfShiftedBits) {
  // 1 bit and 63 bits: the long one has bits in all eight bytes.
  using Layout = canopen::PdoLayout<Entry<1, bool, 1>, Entry<2, std::uint64_t, 63>>;
  const auto data = Layout::pack(true, 0x4000'0000'0000'0001);
  EXPECT_EQ(data, (Data{0x03, 0, 0, 0, 0, 0, 0, 0x80}));
  EXPECT_EQ(Layout::get<1>(data), 0x4000'0000'0000'0001u);
}

TEST(PdoLayout, HasTwoValuesOfFourBitsInAByte) {
  using Layout = canopen::PdoLayout<Entry<1, std::uint8_t, 4>, Entry<2, std::uint8_t, 4>>;
  EXPECT_EQ(Layout::pack(0xF, 0), (Data{0x0F}));
  EXPECT_EQ(Layout::pack(0xA, 0x5), (Data{0x5A}));
}

TEST(PdoLayout, CarriesRealsAndTimes) {
  using Layout = canopen::PdoLayout<Entry<1, float, 32>>;
  EXPECT_EQ(Layout::pack(1.5f), (Data{0x00, 0x00, 0xC0, 0x3F}));
  EXPECT_EQ(Layout::get<0>(Data{0x00, 0x00, 0xC0, 0x3F}), 1.5f);
  using Time = canopen::PdoLayout<Entry<1, canopen::TimeOfDay, 48>>;
  EXPECT_EQ(Time::pack({0x0ABCDEF0, 0x1234}), (Data{0xF0, 0xDE, 0xBC, 0x0A, 0x34, 0x12}));
  EXPECT_EQ(Time::get<0>(Data{0xF0, 0xDE, 0xBC, 0x0A, 0x34, 0x12}), (canopen::TimeOfDay{0x0ABCDEF0, 0x1234}));
}

TEST(PdoLayout, CarriesIntegersOfOddLength) {
  using Layout = canopen::PdoLayout<Entry<1, std::int32_t, 24>, Entry<2, std::int64_t, 40>>;
  const auto data = Layout::pack(-2, -3);
  EXPECT_EQ(data, (Data{0xFE, 0xFF, 0xFF, 0xFD, 0xFF, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(Layout::unpack(data), std::make_tuple(-2, std::int64_t{-3}));
  using Wide = canopen::PdoLayout<Entry<1, std::uint8_t>, Entry<2, std::uint64_t, 56>>;
  EXPECT_EQ(Wide::pack(1, 0x0023'4567'89AB'CDEF), (Data{0x01, 0xEF, 0xCD, 0xAB, 0x89, 0x67, 0x45, 0x23}));
  using Six = canopen::PdoLayout<Entry<1, std::int16_t>, Entry<2, std::int64_t, 48>>;
  EXPECT_EQ(Six::get<1>(Data{0, 0, 0, 0, 0, 0, 0, 0x80}), -0x8000'0000'0000);
}

TEST(PdoLayout, CarriesReal64AndTimeDifference) {
  using Real = canopen::PdoLayout<Entry<1, double>>;
  EXPECT_EQ(Real::pack(1.5), (Data{0, 0, 0, 0, 0, 0, 0xF8, 0x3F}));
  EXPECT_EQ(Real::get<0>(Data{0, 0, 0, 0, 0, 0, 0xF8, 0xBF}), -1.5);
  using Time = canopen::PdoLayout<Entry<1, bool>, Entry<2, canopen::TimeDifference>>;
  const auto data = Time::pack(true, {0x0ABCDEF0, 0x8001});
  EXPECT_EQ(data, (Data{0xE1, 0xBD, 0x79, 0x15, 0x02, 0x00, 0x01}));
  EXPECT_EQ(Time::get<1>(data), (canopen::TimeDifference{0x0ABCDEF0, 0x8001}));
}

TEST(PdoLayout, CarriesABooleanInAWholeByte) {
  using Layout = canopen::PdoLayout<canopen::Padded<Entry<1, bool>, 8>, Entry<2, std::uint8_t>>;
  EXPECT_EQ(Layout::pack(true, 2), (Data{1, 2}));
  EXPECT_TRUE(Layout::get<0>(Data{0x80}));
}

using Text = Entry<1, canopen::VisibleString<10>>;
using Octets = Entry<2, canopen::OctetString<4>>;

TEST(PdoLayout, FillsTextUpWithZeros) {
  using Layout = canopen::PdoLayout<canopen::FixedString<Text, 8>>;
  EXPECT_EQ(Layout::pack("abc"), (Data{'a', 'b', 'c'}));
  EXPECT_EQ(Layout::pack(canopen::VisibleString<10>{"abcdefghij"}), (Data{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}));
  EXPECT_EQ(Layout::get<0>(Data{'a', 'b', 'c'}).view(), "abc");
  EXPECT_EQ(Layout::get<0>(Data{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'}).view(), "abcdefgh");
  EXPECT_EQ(Layout::get<0>(Data{}).view(), "");
}

TEST(PdoLayout, CarriesAsManyOctetsAsTheEntryHas) {
  using Layout = canopen::PdoLayout<Entry<3, std::uint8_t, 4>, canopen::FixedString<Octets, 3>>;
  const auto data = Layout::pack(0xF, {0x12, 0x00});
  EXPECT_EQ(data, (Data{0x2F, 0x01, 0x00, 0x00}));
  const auto octets = Layout::get<1>(Data{0x2F, 0x01, 0x40, 0x05});
  ASSERT_EQ(octets.size, 3);
  EXPECT_EQ(octets.bytes, (std::array<std::uint8_t, 4>{0x12, 0x00, 0x54, 0}));
}

canopen::AbortCode pack_count(std::uint32_t counter, canopen::Frame& frame) {
  const auto count = canopen::CheckedValue<od::unsigned24_value>::from(counter);
  if (!count) return count.abort_code();  // 0609 0031h: above FF FFFFh
  frame.data = sample::Rpdo2::pack(true, true, 0x55, *count);
  return canopen::ok;
}

TEST(PdoLayout, TakesAVariableWithFewerBitsThanItsTypeOnlyAsACheckedValue) {
  canopen::Frame frame;
  EXPECT_EQ(pack_count(0x123456, frame), canopen::ok);
  EXPECT_EQ(frame.data, (Data{0x57, 0x59, 0xD1, 0x48}));
  EXPECT_EQ(pack_count(0x1000000, frame), canopen::AbortCode::value_too_high);
  EXPECT_EQ(frame.data, (Data{0x57, 0x59, 0xD1, 0x48})) << "unchanged";
}

TEST(PdoLayout, ChecksNegativeNumbersAndNumbersOfAWiderType) {
  using Signed = Entry<1, std::int32_t, 24>;
  EXPECT_EQ(canopen::CheckedValue<Signed>::from(-0x800001).abort_code(), canopen::AbortCode::value_too_low);
  EXPECT_EQ(canopen::CheckedValue<Signed>::from(-0x800000)->value(), -0x800000);
  EXPECT_EQ(canopen::CheckedValue<Signed>::from(std::uint64_t{0xFFFF'FFFF'FFFF'FFFF}).abort_code(),
            canopen::AbortCode::value_too_high);
  static_assert(canopen::rejects_values<Signed> && !canopen::rejects_values<Entry<1, std::int32_t>>);
}

TEST(PdoLayout, KeepsTheBitsOfADummy) {
  EXPECT_EQ(sample::Rpdo2::pack(true, true, 0x55, 0x123456), (Data{0x57, 0x59, 0xD1, 0x48}));
  EXPECT_EQ(sample::Rpdo2::get<2>(Data{0x57, 0x59, 0xD1, 0x48}), 0x55U);
  using Real = canopen::Rpdo<canopen::Dummy<0x0008, 32>, Entry<1, std::uint8_t>>;
  EXPECT_EQ(Real::get<1>(Data{0, 0, 0xC0, 0x3F, 0x11}), 0x11);
}

TEST(PdoLayout, FindsAnEntryByItsObject) {
  constexpr Data data{0x31, 0x02, 0xFE, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(sample::Tpdo1::get<od::position_actual_value>(data), -2);
  EXPECT_EQ(sample::Tpdo1::get<od::statusword>(data), 0x0231);
  static_assert(sample::Rpdo2::position_of<od::unsigned24_value> == 3);
}

TEST(PdoLayout, SetsOneEntryAndNoOther) {
  Data data{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
  sample::Tpdo2::set<od::integer40_value>(data, 0);
  EXPECT_EQ(data, (Data{0x03, 0x00, 0x00, 0x00, 0x00, 0xFC, 0xFF, 0xFF}));
  sample::Tpdo2::set<od::inputs::input_1>(data, false);
  EXPECT_EQ(data, (Data{0x02, 0x00, 0x00, 0x00, 0x00, 0xFC, 0xFF, 0xFF}));
  sample::Tpdo2::set<3>(data, canopen::raw(0x81));
  EXPECT_EQ(data, (Data{0x02, 0x00, 0x00, 0x00, 0x00, 0x04, 0xFE, 0xFF}));
}

TEST(PdoLayout, WorksOnAFrameAsOnItsData) {
  canopen::Frame frame{.id = 0x185, .data = {9, 9, 9, 9, 9, 9, 9, 9}};
  sample::Tpdo1::pack_into(frame, 0x0231, 0x12345678);
  EXPECT_EQ(frame.size, 6);
  EXPECT_EQ(frame.data, (Data{0x31, 0x02, 0x78, 0x56, 0x34, 0x12, 9, 9}));
  sample::Tpdo1::set<od::statusword>(frame, 0x0637);
  EXPECT_EQ(sample::Tpdo1::get<0>(frame), 0x0637);
  EXPECT_EQ(sample::Tpdo1::get<od::position_actual_value>(frame), 0x12345678);
  EXPECT_EQ(sample::Tpdo1::unpack(frame), std::make_tuple(std::uint16_t{0x0637}, 0x12345678));
}

TEST(PdoLayout, IsCodedWhileTheProgramIsCompiled) {
  constexpr Data data = [] {
    Data bytes = sample::Tpdo2::pack(true, true, -1, canopen::raw(0xFF));
    sample::Tpdo2::set<od::integer40_value>(bytes, 1);
    return bytes;
  }();
  static_assert(data == Data{0x07, 0x00, 0x00, 0x00, 0x00, 0xFC, 0x03});
  static_assert(sample::Tpdo2::get<od::error_register>(data).raw() == 0xFF);
  using Layout = canopen::PdoLayout<canopen::FixedString<Octets, 2>>;
  static_assert(Layout::pack({1, 2}) == Data{1, 2});
  static_assert(Layout::get<0>(Data{3, 4}).bytes[1] == 4);
}

}  // namespace
