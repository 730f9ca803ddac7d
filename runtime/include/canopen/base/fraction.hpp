/// Exact fractions for constants. The compiler evaluates them: a result beyond 64 bits is a compile error.
#pragma once

#include <cstdint>
#include <numeric>

namespace canopen {

/// A fraction in lowest terms with a positive denominator.
struct Fraction {
  constexpr Fraction() = default;
  /// The denominator must not be 0.
  constexpr Fraction(std::int64_t over, std::int64_t under) : numerator{over}, denominator{under} {
    const std::int64_t common = std::gcd(over, under);
    numerator /= common;
    denominator /= common;
    if (denominator < 0) {
      numerator = -numerator;
      denominator = -denominator;
    }
  }
  /// The value of a std::ratio.
  template <class Ratio>
  [[nodiscard]] static constexpr Fraction of() {
    return {Ratio::num, Ratio::den};
  }

  [[nodiscard]] constexpr bool is_whole() const { return denominator == 1; }
  /// The largest integer that is not above the fraction.
  [[nodiscard]] constexpr std::int64_t floor() const {
    return numerator / denominator - (numerator % denominator < 0 ? 1 : 0);
  }

  friend constexpr bool operator==(const Fraction&, const Fraction&) = default;
  friend constexpr Fraction operator*(Fraction left, Fraction right) {
    const Fraction first{left.numerator, right.denominator};  // reduced before the products, which may overflow
    const Fraction second{right.numerator, left.denominator};
    return {first.numerator * second.numerator, first.denominator * second.denominator};
  }
  friend constexpr Fraction operator/(Fraction left, Fraction right) {
    return left * Fraction{right.denominator, right.numerator};
  }
  friend constexpr Fraction operator+(Fraction left, Fraction right) {
    const std::int64_t common = std::lcm(left.denominator, right.denominator);
    return {left.numerator * (common / left.denominator) + right.numerator * (common / right.denominator), common};
  }
  friend constexpr Fraction operator-(Fraction left, Fraction right) {
    return left + Fraction{-right.numerator, right.denominator};
  }

  std::int64_t numerator = 0;
  std::int64_t denominator = 1;
};

}  // namespace canopen
