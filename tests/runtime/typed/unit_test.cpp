#include <gtest/gtest.h>
#include <canopen/od/unit.hpp>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

namespace {

using canopen::Dimension;
using canopen::find_unit;
using canopen::Fraction;
using canopen::UnitRow;

Fraction in(Fraction value, std::string_view from, std::string_view to) {
  const UnitRow* const first = find_unit(from);
  const UnitRow* const second = find_unit(to);
  EXPECT_NE(first, nullptr) << from;
  EXPECT_NE(second, nullptr) << to;
  EXPECT_EQ(first->dimension, second->dimension) << from << ' ' << to;
  return canopen::convert(value, *first, *second);
}

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F; });
}

TEST(Unit, IsFoundByEachSpellingWhichNoOtherUnitHas) {
  std::set<std::string_view> names;
  std::set<std::string_view> literals;
  std::set<std::string_view> spellings;
  for (const UnitRow& row : canopen::unit_rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(literals.insert(row.literal).second) << row.literal;
    std::set<std::string_view> own{row.symbol, row.ascii};
    for (std::string_view rest = row.other_spellings; !rest.empty();) {
      const std::size_t end = rest.find(';');
      const std::string_view other = rest.substr(0, end);
      rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
      EXPECT_TRUE(own.insert(other).second) << row.name << " has " << other << " twice";
    }
    for (const std::string_view spelling : own) {
      EXPECT_TRUE(spellings.insert(spelling).second) << spelling;
      EXPECT_EQ(find_unit(spelling), &row) << spelling;
    }
    EXPECT_TRUE(is_ascii(row.ascii)) << row.ascii;
    EXPECT_GT(row.factor.numerator, 0) << row.name;
  }
  EXPECT_EQ(names.size(), std::size(canopen::unit_rows));
}

TEST(Unit, HasTypeAndRowOfOneName) {
  EXPECT_EQ(canopen::unit::degree_celsius::row.name, "degree_celsius");
  EXPECT_EQ(&canopen::unit::degree_celsius::row, find_unit("°C"));
  static_assert(canopen::unit::revolution_per_minute::row.dimension == Dimension::rotational_speed);
}

TEST(Unit, OfAnotherCaseOrWithoutTextIsUnknown) {
  EXPECT_EQ(find_unit(""), nullptr);
  EXPECT_EQ(find_unit("degc"), nullptr);
  EXPECT_EQ(find_unit("KW"), nullptr);
  EXPECT_EQ(find_unit("furlong"), nullptr);
  EXPECT_NE(find_unit("mW"), find_unit("MW"));
}

TEST(Unit, HasOtherSpellings) {
  EXPECT_EQ(find_unit("1/min"), find_unit("rpm"));
  EXPECT_EQ(find_unit("\u03BCm"), find_unit("\u00B5m"));  // Greek mu and the micro sign
  EXPECT_EQ(find_unit("\u2126"), find_unit("\u03A9"));    // the ohm sign and Greek omega
  EXPECT_EQ(find_unit("degC"), find_unit("°C"));
}

TEST(Unit, IsConvertedExactly) {
  EXPECT_EQ(in({215, 10}, "°C", "K"), (Fraction{29465, 100}));
  EXPECT_EQ(in({-40, 1}, "degC", "degF"), (Fraction{-40, 1}));
  EXPECT_EQ(in({0, 1}, "K", "°F"), (Fraction{-45967, 100}));
  EXPECT_EQ(in({3, 2}, "kV", "mV"), (Fraction{1'500'000, 1}));
  EXPECT_EQ(in({90, 1}, "deg", "rev"), (Fraction{1, 4}));
  EXPECT_EQ(in({3'000, 1}, "rpm", "rev/s"), (Fraction{50, 1}));
  EXPECT_EQ(in({1, 1}, "rpm", "deg/s"), (Fraction{6, 1}));
  EXPECT_EQ(in({36, 1}, "km/h", "m/s"), (Fraction{10, 1}));
  EXPECT_EQ(in({60, 1}, "m/min", "mm/s"), (Fraction{1'000, 1}));
  EXPECT_EQ(in({5, 1}, "kWh", "J"), (Fraction{18'000'000, 1}));
  EXPECT_EQ(in({1, 1}, "Ah", "C"), (Fraction{3'600, 1}));
  EXPECT_EQ(in({1, 1}, "bar", "hPa"), (Fraction{1'000, 1}));
  EXPECT_EQ(in({25, 1}, "%", "permille"), (Fraction{250, 1}));
  EXPECT_EQ(in({1, 1}, "l/min", "m3/h"), (Fraction{6, 100}));
  EXPECT_EQ(in({2, 1}, "byte", "bit"), (Fraction{16, 1}));
  EXPECT_EQ(in({1, 1}, "g·cm²", "kg·m²"), (Fraction{1, 10'000'000}));
}

TEST(Unit, OfTheRadianIsExactAmongItsOwnOnly) {
  EXPECT_FALSE(canopen::is_exact_conversion(*find_unit("rad"), *find_unit("deg")));
  EXPECT_TRUE(canopen::is_exact_conversion(*find_unit("rad"), *find_unit("mrad")));
  EXPECT_TRUE(canopen::is_exact_conversion(*find_unit("deg"), *find_unit("rev")));
  EXPECT_FALSE(canopen::is_exact_conversion(*find_unit("deg"), *find_unit("V")));
  EXPECT_EQ(in({1, 1}, "rad", "mrad"), (Fraction{1'000, 1}));
  const Fraction degrees = in({1, 1}, "rad", "deg");
  EXPECT_DOUBLE_EQ(static_cast<double>(degrees.numerator) / static_cast<double>(degrees.denominator),
                   57.295779513082320877);
}

TEST(Fraction, IsInLowestTermsWithAPositiveDenominator) {
  EXPECT_EQ((Fraction{6, -4}), (Fraction{-3, 2}));
  EXPECT_EQ((Fraction{0, -7}), (Fraction{0, 1}));
  EXPECT_EQ((Fraction{1, 6} + Fraction{1, 10}), (Fraction{4, 15}));
  EXPECT_EQ((Fraction{1, 6} - Fraction{1, 6}), (Fraction{}));
  EXPECT_EQ((Fraction{2, 3} / Fraction{-4, 9}), (Fraction{-3, 2}));
  EXPECT_EQ((Fraction{3'000'000'000, 7} * Fraction{7, 3'000'000'000}), (Fraction{1, 1}));
}

TEST(Fraction, IsRoundedDown) {
  EXPECT_EQ((Fraction{7, 2}).floor(), 3);
  EXPECT_EQ((Fraction{-7, 2}).floor(), -4);
  EXPECT_EQ((Fraction{-8, 2}).floor(), -4);
  EXPECT_TRUE((Fraction{-8, 2}).is_whole());
  EXPECT_FALSE((Fraction{1, 2}).is_whole());
}

}  // namespace
