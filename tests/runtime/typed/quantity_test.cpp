#include <gtest/gtest.h>
#include <canopen/od/quantity.hpp>

#include <cstdint>
#include <ratio>
#include <type_traits>

#include <typed_drive/device.hpp>
#include <typed_drive/meaning_text.hpp>

namespace {

using namespace canopen::literals;
namespace unit = canopen::unit;
namespace od = typed_drive::od;
using depth = od::cooling_depth::type;
using energy = od::total_energy::type;
using position = od::target_position::type;
using temperature = od::temperature::type;

constexpr temperature celsius(int tenths) { return temperature{canopen::raw(static_cast<std::int16_t>(tenths))}; }

static_assert(sizeof(temperature) == 2 && sizeof(energy) == 8);
static_assert(temperature{21.5_degC}.raw() == 215);
static_assert(temperature{-5_degC}.raw() == -50);
static_assert(temperature{294.65_K}.raw() == 215);
static_assert(temperature{70.7_degF}.raw() == 215);
static_assert(position{90_deg}.raw() == 2'500);
static_assert(position{-0.5_rev}.raw() == -5'000);
static_assert(energy{1.5_kWh}.raw() == 1'500);

// A negative scale: -1/2 K for each step.
static_assert(depth{-10_K}.raw() == 20 && depth{3.5_K}.raw() == -7);

TEST(Quantity, IsInAUnitOfItsDimension) {
  EXPECT_DOUBLE_EQ(celsius(215).in(), 21.5);
  EXPECT_DOUBLE_EQ(celsius(215).in<unit::kelvin>(), 294.65);
  EXPECT_DOUBLE_EQ(celsius(-400).in<unit::degree_fahrenheit>(), -40.0);
  EXPECT_DOUBLE_EQ(position{0.25_rev}.in<unit::radian>(), 1.5707963267948966);
}

TEST(Quantity, IsCountedInWholeStepsRoundedToNearest) {
  static_assert(std::is_same_v<decltype(celsius(0).count()), std::int32_t>);
  for (int tenths = -32768; tenths <= 32767; ++tenths) {
    const int hundredths = tenths * 10 + 27'315;
    const int nearest = hundredths + 50 >= 0 ? (hundredths + 50) / 100 : -((-hundredths - 50 + 99) / 100);
    ASSERT_EQ(celsius(tenths).count<unit::kelvin>(), nearest) << tenths;
    ASSERT_EQ((celsius(tenths).count<unit::kelvin, std::ratio<1, 100>>()), hundredths) << tenths;
  }
  EXPECT_EQ(position{0.25_rev}.count<unit::degree>(), 90);
  EXPECT_EQ((position{canopen::raw(std::int32_t{INT32_MIN})}.count<unit::degree>()), -77'309'411);
  EXPECT_EQ(depth{canopen::raw(std::int16_t{3})}.count<unit::kelvin>(), -1);
  EXPECT_EQ(depth{canopen::raw(std::int16_t{-32768})}.count<unit::kelvin>(), 16'384);
  EXPECT_EQ(energy{canopen::raw(std::uint64_t{2'499})}.count<unit::kilowatt_hour>(), 2);
}

/// The nearest raw number by long division, halves upwards.
int nearest(long long dividend, long long divisor) {
  const long long doubled = 2 * dividend + divisor, twice = 2 * divisor;
  return static_cast<int>(doubled / twice - (doubled % twice < 0 ? 1 : 0));
}

TEST(Quantity, IsRoundedFromStepsOfAUnit) {
  for (int hundredths = -20'000; hundredths <= 60'000; ++hundredths) {
    // Tenths of °C: (K - 273.15) * 10.
    const auto value = temperature::rounded<unit::kelvin, std::ratio<1, 100>>(hundredths);
    ASSERT_TRUE(value) << hundredths;
    ASSERT_EQ(value->raw(), nearest(hundredths - 27'315, 10)) << hundredths;
  }
  // Each value is the nearest to the count of its own steps.
  for (int tenths = -32768; tenths <= 32767; ++tenths) {
    const int count = celsius(tenths).count<unit::kelvin, std::ratio<1, 100>>();
    ASSERT_EQ((temperature::rounded<unit::kelvin, std::ratio<1, 100>>(count))->raw(), tenths);
  }
  EXPECT_EQ(temperature::rounded(21)->raw(), 210);
  EXPECT_EQ((temperature::rounded<unit::degree_celsius, std::ratio<1, 100>>(2145))->raw(), 215) << "a half";
  EXPECT_EQ((temperature::rounded<unit::degree_celsius, std::ratio<1, 100>>(-2145))->raw(), -214) << "a half";
  EXPECT_EQ(position::rounded<unit::degree>(90)->raw(), 2'500);
  EXPECT_EQ(position::rounded<unit::degree>(std::int16_t{-1})->raw(), -28) << "-27.8";
  EXPECT_EQ(depth::rounded<unit::kelvin>(16'384)->raw(), -32768) << "a falling scale";
  EXPECT_EQ(energy::rounded<unit::kilowatt_hour>(4'294'967'295U)->raw(), 4'294'967'295'000U);
}

TEST(Quantity, IsNotRoundedBeyondItsType) {
  EXPECT_EQ(temperature::rounded(3'276)->raw(), 32'760);
  EXPECT_EQ(temperature::rounded(3'277).abort_code(), canopen::AbortCode::value_too_high);
  EXPECT_EQ(temperature::rounded(-3'277).abort_code(), canopen::AbortCode::value_too_low);
  EXPECT_EQ(temperature::rounded(INT32_MAX).abort_code(), canopen::AbortCode::value_too_high);
  EXPECT_EQ(temperature::rounded(INT32_MIN).abort_code(), canopen::AbortCode::value_too_low);
  EXPECT_EQ(energy::rounded<unit::kilowatt_hour>(-1).abort_code(), canopen::AbortCode::value_too_low);
  static_assert(temperature::rounded<unit::kelvin>(295)->raw() == 219, "21.85 °C, a half");
}

TEST(Quantity, IsComparedWithConstantsBetweenItsValues) {
  EXPECT_TRUE(celsius(268) < 300_K);   // 26.8 °C is 299.95 K
  EXPECT_FALSE(celsius(269) < 300_K);  // 26.9 °C is 300.05 K
  EXPECT_TRUE(celsius(268) <= 300_K);
  EXPECT_TRUE(celsius(269) > 300_K);
  EXPECT_TRUE(300_K < celsius(269));
  EXPECT_TRUE(celsius(215) == 21.5_degC);
  EXPECT_TRUE(21.5_degC != celsius(216));
  EXPECT_TRUE(celsius(32767) < 100'000_degC);  // beyond the type
  EXPECT_FALSE(celsius(32767) > 100'000_degC);
  EXPECT_TRUE(celsius(-32768) > -100'000_degC);
  EXPECT_TRUE(energy{canopen::raw(UINT64_MAX)} > 1_MWh);
}

TEST(Quantity, OfANegativeScaleIsComparedByItsValue) {
  const depth deep{canopen::raw(std::int16_t{20})};  // -10 K
  const depth flat{canopen::raw(std::int16_t{0})};
  EXPECT_TRUE(deep < flat);
  EXPECT_TRUE(deep < -9.9_K);
  EXPECT_FALSE(deep < -10_K);
  EXPECT_TRUE(deep <= -10_K);
  EXPECT_TRUE(flat > -0.1_K);
  EXPECT_TRUE(-0.1_K < flat);
  EXPECT_FALSE(flat > 0_K);
}

TEST(Quantity, IsComparedWithAnotherOneOfItsDimension) {
  using Kelvin = canopen::Quantity<std::uint16_t, unit::kelvin>;
  const Kelvin room{300_K};
  EXPECT_TRUE(celsius(268) < room);
  EXPECT_TRUE(celsius(269) > room);
  EXPECT_FALSE(celsius(269) == room);
  EXPECT_TRUE(Kelvin{0_K} < celsius(-2731));
  using Degrees = canopen::Quantity<std::int16_t, unit::degree>;
  EXPECT_TRUE(Degrees{90_deg} == position{0.25_rev});
  EXPECT_TRUE(Degrees{90_deg} < position{canopen::raw(std::int32_t{2'501})});
}

TEST(Quantity, OfADifferenceHasNoOffset) {
  const auto difference = celsius(215) - celsius(200);
  static_assert(std::is_same_v<decltype(difference)::unit, canopen::DifferenceOf<unit::degree_celsius>>);
  EXPECT_EQ(difference.raw(), 15);
  EXPECT_TRUE(difference == 1.5_K);
  EXPECT_DOUBLE_EQ(difference.in<unit::kelvin>(), 1.5);
  EXPECT_EQ((celsius(200) - celsius(215)).raw(), -15);
  EXPECT_EQ((celsius(32767) - celsius(-32768)).raw(), 65'535);  // 32 bits
}

TEST(Quantity, PlusADifferenceIsOfItsUnit) {
  const auto warmer = celsius(215) + 0.5_K;
  EXPECT_TRUE(warmer == 22_degC);
  EXPECT_EQ(temperature::clamped(warmer), temperature{22_degC});
  EXPECT_TRUE(celsius(215) - 30_K == -8.5_degC);
  EXPECT_TRUE(celsius(215) + (celsius(300) - celsius(250)) == 26.5_degC);
  EXPECT_EQ((celsius(215) + 0.05_K).count(), 22);  // 21.55 °C
  EXPECT_TRUE(position{0.25_rev} + position{0.5_rev} == 270_deg);
  EXPECT_TRUE(position{0.25_rev} - 90_deg == 0_rev);
  EXPECT_EQ((position{0.25_rev} + 0_deg).raw(), 2'500);
}

TEST(Quantity, OfMoreBitsIsCheckedOrClamped) {
  const auto hot = celsius(32'767) + 0.1_K;
  EXPECT_EQ(temperature::from(hot).abort_code(), canopen::AbortCode::value_too_high);
  EXPECT_EQ(temperature::clamped(hot).raw(), 32'767);
  EXPECT_EQ(temperature::from(celsius(-32'768) - 0.1_K).abort_code(), canopen::AbortCode::value_too_low);
  EXPECT_EQ(temperature::clamped(celsius(-32'768) - 0.1_K).raw(), -32'768);
  EXPECT_EQ(temperature::from(celsius(10) + 0.1_K)->raw(), 11);
}

TEST(Fields, AreReadAndWrittenByName) {
  using typed_drive::meaning::controlword;
  using typed_drive::meaning::door;
  controlword word;
  word.quick_stop(true).halt(true);
  EXPECT_EQ(word.raw(), 0x0104);
  EXPECT_TRUE(word.all(controlword{}.quick_stop(true).halt(true)));
  EXPECT_FALSE(word.all(controlword{}.quick_stop(true).switch_on(true)));
  EXPECT_TRUE(word.any(controlword{}.quick_stop(true).switch_on(true)));
  word.profile_position().new_set_point(true).relative(true);
  EXPECT_EQ(word.raw(), 0x0154);
  word.halt(false);
  EXPECT_EQ(word.raw(), 0x0054);

  door state{canopen::raw(std::uint8_t{0xFF})};
  EXPECT_EQ(state.zone(), 15);
  EXPECT_EQ(state.trim(), -1);
  state.zone(3).trim(-2);
  EXPECT_EQ(state.raw(), 0x3B);
  state.zone(canopen::low_bits(0x15));
  EXPECT_EQ(state.zone(), 5);
  state.zone(canopen::clamped(99));
  EXPECT_EQ(state.zone(), 15);
  EXPECT_EQ(state.trim(), -2);
}

TEST(Fields, OfACaseAreReadFromACopyOrWrittenInTheWord) {
  using typed_drive::meaning::controlword;
  constexpr controlword constant{canopen::raw(std::uint16_t{0x0050})};
  const auto fields = constant.profile_position();
  EXPECT_TRUE(fields.new_set_point());
  controlword word = constant;
  auto reference = word.profile_position();
  reference.relative(false);
  EXPECT_FALSE(reference.relative());
  EXPECT_EQ(word.raw(), 0x0010);
  EXPECT_TRUE(controlword{constant}.profile_position().relative());
}

TEST(Fields, HaveMaskedValues) {
  using typed_drive::meaning::statusword;
  using state = statusword::state_value;
  EXPECT_TRUE(statusword{canopen::raw(std::uint16_t{0x0237})}.is(state::operation_enabled));
  EXPECT_FALSE(statusword{canopen::raw(std::uint16_t{0x0233})}.is(state::operation_enabled));
  EXPECT_TRUE(statusword{canopen::raw(std::uint16_t{0x1000})}.profile_position().set_point_acknowledge());
  statusword word{canopen::raw(std::uint16_t{0xFFFF})};
  word.state(state::fault);
  EXPECT_EQ(word.raw(), 0xFFB8);
  EXPECT_TRUE(word.is(state::fault));
  word.state(state::operation_enabled);
  EXPECT_EQ(word.raw(), 0xFFB7);
  EXPECT_FALSE(word.is(state::fault));
}

TEST(Enumerations, AreSharedAndHaveTexts) {
  static_assert(std::is_same_v<od::modes_of_operation::type, od::modes_of_operation_display::type>);
  using state = typed_drive::meaning::statusword::state_value;
  EXPECT_EQ(to_text(od::modes_of_operation::value::profile_velocity), "profile_velocity");
  EXPECT_EQ(to_text(static_cast<od::heater_state::value>(3)), "");
  EXPECT_EQ(typed_drive::meaning::to_text(state::switch_on_disabled), "switch_on_disabled");
}

}  // namespace
