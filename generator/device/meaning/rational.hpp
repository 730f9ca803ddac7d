/// Exact numbers: scales, offsets and physical values.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edsc {

/// A fraction of 64-bit integers in lowest terms, with a positive denominator. Operations return nothing where the
/// result does not fit.
class Rational {
 public:
  constexpr Rational() = default;
  constexpr explicit Rational(std::int64_t integer) : numerator_{integer} {}

  /// Nothing for a denominator of 0.
  [[nodiscard]] static std::optional<Rational> of(std::int64_t numerator, std::int64_t denominator);

  [[nodiscard]] constexpr std::int64_t numerator() const { return numerator_; }
  [[nodiscard]] constexpr std::int64_t denominator() const { return denominator_; }
  [[nodiscard]] constexpr bool is_integer() const { return denominator_ == 1; }
  [[nodiscard]] double to_double() const { return static_cast<double>(numerator_) / static_cast<double>(denominator_); }

  friend constexpr bool operator==(const Rational&, const Rational&) = default;
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b);

 private:
  std::int64_t numerator_ = 0;
  std::int64_t denominator_ = 1;
};

[[nodiscard]] std::optional<Rational> sum(const Rational& a, const Rational& b);
[[nodiscard]] std::optional<Rational> difference(const Rational& a, const Rational& b);
[[nodiscard]] std::optional<Rational> product(const Rational& a, const Rational& b);
/// Nothing for a divisor of 0.
[[nodiscard]] std::optional<Rational> quotient(const Rational& a, const Rational& b);

/// The largest integer that is not above the number.
[[nodiscard]] std::int64_t floor_of(const Rational& number);

/// Reads `1/10`, `-40`, `0.001`, `1e-3`; blanks may surround it.
[[nodiscard]] std::optional<Rational> parse_rational(std::string_view text);

/// `21.5`; a fraction that is not a finite decimal is rounded to this number of decimals.
[[nodiscard]] std::string decimal_text(const Rational& number, unsigned decimals = 6);

/// `1/10`, `3`: the exact number.
[[nodiscard]] std::string fraction_text(const Rational& number);

}  // namespace edsc
