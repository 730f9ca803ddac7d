#include <gtest/gtest.h>
#include <canopen/od/quantity.hpp>
#include <canopen/pdo/pdo_compatible.hpp>
#include <canopen/pdo/pdo_list.hpp>

#include <cstdint>
#include <ratio>

#include <sample/pdo.hpp>

namespace {

using canopen::Access;
using canopen::compatible;
using canopen::CompatiblePdos;
using canopen::Dummy;
using canopen::Mappable;
using canopen::Rpdo;
using canopen::Tpdo;

/// Objects of two devices: the indices do not matter.
template <std::uint8_t SubIndex, class T, std::uint16_t Bits = canopen::wire_bits<T>>
using Sent = canopen::Object<0x2000, SubIndex, T, Access::ro, Mappable::tpdo, Bits>;
template <std::uint8_t SubIndex, class T, std::uint16_t Bits = canopen::wire_bits<T>>
using Received = canopen::Object<0x3000, SubIndex, T, Access::rww, Mappable::rpdo, Bits>;

using Status = Tpdo<Sent<1, std::uint16_t>, Sent<2, std::int32_t>>;

TEST(CompatiblePdos, AreThoseOfTheSameLayout) {
  EXPECT_TRUE((compatible<Status, Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t>>>));
  EXPECT_TRUE((CompatiblePdos<Status, Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t>>>::hold));
}

TEST(CompatiblePdos, UnderstandEachOther) {
  using Consumer = Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t>>;
  constexpr auto data = Status::pack(0x0237, -5);
  EXPECT_EQ(data, (std::array<std::uint8_t, 8>{0x37, 0x02, 0xFB, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(Consumer::unpack(data), std::make_tuple(std::uint16_t{0x0237}, -5));
}

TEST(CompatiblePdos, MayEndSoonerAtTheConsumer) {
  EXPECT_TRUE((compatible<Status, Rpdo<Received<1, std::uint16_t>>>));
  EXPECT_TRUE((compatible<Status, Rpdo<>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, std::uint16_t>>, Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t>>>));
}

TEST(CompatiblePdos, HaveEntriesOfTheSameLength) {
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t, 24>>>));
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::uint8_t>, Received<2, std::uint8_t>>>));
}

TEST(CompatiblePdos, HaveEntriesThatBeginAtTheSameBit) {
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::int32_t>, Received<2, std::uint16_t>>>));
  EXPECT_FALSE(
      (compatible<Tpdo<Sent<1, std::uint32_t>>, Rpdo<Received<1, std::uint16_t>, Received<2, std::uint16_t>>>));
}

TEST(CompatiblePdos, HaveEntriesOfTheSameKind) {
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::int16_t>>>));
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::uint16_t>, Received<2, std::uint32_t>>>));
  EXPECT_FALSE((compatible<Status, Rpdo<Received<1, std::uint16_t>, Received<2, float>>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, bool>>, Rpdo<Received<1, std::uint8_t, 1>>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, canopen::TimeOfDay>>, Rpdo<Received<1, std::uint64_t, 48>>>));
  using Text = canopen::FixedString<Sent<1, canopen::VisibleString<8>>, 4>;
  EXPECT_FALSE((compatible<Tpdo<Text>, Rpdo<Received<1, std::uint32_t>>>));
  EXPECT_TRUE((compatible<Tpdo<Text>, Rpdo<canopen::FixedString<Received<1, canopen::OctetString<4>>, 4>>>));
}

TEST(CompatiblePdos, HaveTheSameRawNumbersInAnyUnitOfADimension) {
  namespace unit = canopen::unit;
  using Volts = canopen::Quantity<std::int16_t, unit::volt, std::ratio<1, 100>, std::ratio<0>>;
  using TensOfMillivolts = canopen::Quantity<std::int16_t, unit::millivolt, std::ratio<10>, std::ratio<0>>;
  using Millivolts = canopen::Quantity<std::int16_t, unit::millivolt, std::ratio<1>, std::ratio<0>>;
  using Celsius = canopen::Quantity<std::int16_t, unit::degree_celsius, std::ratio<1>, std::ratio<0>>;
  using Kelvin = canopen::Quantity<std::int16_t, unit::kelvin, std::ratio<1>, std::ratio<27315, 100>>;
  using AbsoluteKelvin = canopen::Quantity<std::int16_t, unit::kelvin, std::ratio<1>, std::ratio<0>>;
  EXPECT_TRUE((compatible<Tpdo<Sent<1, Volts, 16>>, Rpdo<Received<1, TensOfMillivolts, 16>>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, Volts, 16>>, Rpdo<Received<1, Millivolts, 16>>>));
  EXPECT_TRUE((compatible<Tpdo<Sent<1, Celsius, 16>>, Rpdo<Received<1, Kelvin, 16>>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, Celsius, 16>>, Rpdo<Received<1, AbsoluteKelvin, 16>>>));
  EXPECT_FALSE((compatible<Tpdo<Sent<1, Celsius, 16>>, Rpdo<Received<1, Volts, 16>>>));
}

TEST(CompatiblePdos, MayDifferWhereTheConsumerHasADummy) {
  EXPECT_TRUE((compatible<Status, Rpdo<Dummy<0x0003, 16>, Received<2, std::int32_t>>>));
  EXPECT_TRUE((compatible<Tpdo<Sent<1, std::uint8_t>, Sent<2, std::uint8_t>, Sent<3, bool>>,
                          Rpdo<Dummy<0x0006, 16>, Received<1, bool>>>))
      << "one dummy over two entries";
  EXPECT_FALSE((compatible<Tpdo<Sent<1, std::uint8_t>>, Rpdo<Dummy<0x0006, 16>>>)) << "the frame is too short";
}

TEST(CompatiblePdos, MayBeNumbered) {
  using Numbered = canopen::NumberedPdo<1, sample::Tpdo1>;
  EXPECT_TRUE((compatible<Numbered, Rpdo<Received<1, std::uint16_t>, Received<2, std::int32_t>>>));
  EXPECT_FALSE((compatible<Numbered, sample::Rpdo1>));
}

}  // namespace
