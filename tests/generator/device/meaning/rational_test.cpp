#include "device/meaning/rational.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace edsc {
namespace {

constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();

Rational fraction(std::int64_t numerator, std::int64_t denominator) { return *Rational::of(numerator, denominator); }

TEST(Rational, IsInLowestTerms) {
  EXPECT_EQ(fraction(6, -4).numerator(), -3);
  EXPECT_EQ(fraction(6, -4).denominator(), 2);
  EXPECT_EQ(fraction(0, 7), Rational{0});
  EXPECT_FALSE(Rational::of(1, 0));
}

TEST(Rational, ReadsDecimalsFractionsAndExponents) {
  const struct {
    const char* text;
    Rational number;
  } rows[] = {
      {"1/10", fraction(1, 10)},    {" -40 ", Rational{-40}},
      {"0.001", fraction(1, 1000)}, {"1e-3", fraction(1, 1000)},
      {"2.5E2", Rational{250}},     {"0.1/3", fraction(1, 30)},
      {".5", fraction(1, 2)},       {"9223372036854775807", Rational{largest}},
  };
  for (const auto& row : rows) EXPECT_EQ(parse_rational(row.text), row.number) << row.text;
  for (const char* const text :
       {"", "x", "1/0", "1/", "/2", "1 2", "0,1", "1e", "9223372036854775808", "1e30", "--1"}) {
    EXPECT_FALSE(parse_rational(text)) << text;
  }
}

TEST(Rational, IsPrintedAsAnExactDecimalOrRounded) {
  EXPECT_EQ(decimal_text(fraction(43, 2)), "21.5");
  EXPECT_EQ(decimal_text(fraction(-1, 8)), "-0.125");
  EXPECT_EQ(decimal_text(Rational{-7}), "-7");
  EXPECT_EQ(decimal_text(fraction(1, 3), 3), "0.333");
  EXPECT_EQ(decimal_text(fraction(2, 3), 3), "0.667");
  EXPECT_EQ(decimal_text(fraction(299, 300), 2), "1");
  EXPECT_EQ(decimal_text(fraction(1, 1'000'000'000'000)), "0.000000000001") << "a finite decimal is not rounded";
  EXPECT_EQ(fraction_text(fraction(2, 20)), "1/10");
  EXPECT_EQ(fraction_text(Rational{3}), "3");
}

TEST(Rational, HasNoResultThatDoesNotFit) {
  EXPECT_FALSE(product(Rational{largest}, Rational{2}));
  EXPECT_FALSE(sum(Rational{largest}, Rational{1}));
  EXPECT_FALSE(quotient(Rational{1}, Rational{0}));
  EXPECT_EQ(product(Rational{largest}, fraction(1, largest)), Rational{1});
  EXPECT_EQ(difference(fraction(1, 2), fraction(1, 3)), fraction(1, 6));
}

TEST(Rational, IsOrderedExactly) {
  EXPECT_LT(fraction(-1, 2), fraction(-1, 3));
  EXPECT_LT(fraction(largest - 1, largest), Rational{1});
  EXPECT_LT(fraction(1, largest), fraction(1, largest - 1));
  EXPECT_GT(fraction(7, 2), fraction(10, 3));
  EXPECT_EQ(floor_of(fraction(-1, 2)), -1);
  EXPECT_EQ(floor_of(fraction(7, 2)), 3);
}

}  // namespace
}  // namespace edsc
