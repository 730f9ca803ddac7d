#include "device/meaning/rational.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "text/ascii.hpp"

namespace edsc {
namespace {

using Integer = std::int64_t;

std::optional<Integer> multiplied(Integer a, Integer b) {
  Integer result = 0;
  return __builtin_mul_overflow(a, b, &result) ? std::nullopt : std::optional{result};
}

std::optional<Integer> added(Integer a, Integer b) {
  Integer result = 0;
  return __builtin_add_overflow(a, b, &result) ? std::nullopt : std::optional{result};
}

std::uint64_t magnitude(Integer number) {
  return number < 0 ? 0 - static_cast<std::uint64_t>(number) : static_cast<std::uint64_t>(number);
}

Integer common_divisor(Integer a, Integer b) { return static_cast<Integer>(std::gcd(magnitude(a), magnitude(b))); }

Rational negative(const Rational& number) { return *Rational::of(-number.numerator(), number.denominator()); }

/// The decimal digits of an unsigned number of the text, before and after its point.
struct Digits {
  std::string_view integer, fraction;
};

bool all_digits(std::string_view text) {
  return std::ranges::all_of(text, [](char one) { return one >= '0' && one <= '9'; });
}

std::optional<Rational> power_of_ten(int exponent) {
  constexpr int max_exponent = 18;
  if (exponent < -max_exponent || exponent > max_exponent) return std::nullopt;
  Integer power = 1;
  for (int i = 0; i < (exponent < 0 ? -exponent : exponent); ++i) power *= 10;
  return exponent < 0 ? Rational::of(1, power) : Rational::of(power, 1);
}

std::optional<Integer> parse_integer(std::string_view digits, bool is_negative) {
  Integer number = 0;
  for (const char digit : digits) {
    const auto tens = multiplied(number, 10);
    const auto next = tens ? added(*tens, is_negative ? -(digit - '0') : digit - '0') : std::nullopt;
    if (!next) return std::nullopt;
    number = *next;
  }
  return number;
}

/// Reads `-12.5e-3`.
std::optional<Rational> parse_decimal_number(std::string_view text) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  int exponent = 0;
  if (const std::size_t at = text.find_first_of("eE"); at != std::string_view::npos) {
    std::string_view digits = text.substr(at + 1);
    const bool is_small = digits.starts_with('-');
    if (is_small || digits.starts_with('+')) digits.remove_prefix(1);
    if (digits.empty() || digits.size() > 2 || !all_digits(digits)) return std::nullopt;
    exponent = static_cast<int>(*parse_integer(digits, is_small));
    text = text.substr(0, at);
  }
  const std::size_t point = text.find('.');
  const Digits digits{text.substr(0, point), point == std::string_view::npos ? "" : text.substr(point + 1)};
  if (digits.integer.empty() && digits.fraction.empty()) return std::nullopt;
  if (!all_digits(digits.integer) || !all_digits(digits.fraction)) return std::nullopt;
  std::string_view fraction = digits.fraction;
  while (fraction.ends_with('0')) fraction.remove_suffix(1);
  const auto number = parse_integer(std::string{digits.integer}.append(fraction), is_negative);
  if (!number || fraction.size() > 18) return std::nullopt;
  const auto scale = power_of_ten(exponent - static_cast<int>(fraction.size()));
  return scale ? product(Rational{*number}, *scale) : std::nullopt;
}

}  // namespace

std::optional<Rational> Rational::of(std::int64_t numerator, std::int64_t denominator) {
  constexpr Integer min = std::numeric_limits<Integer>::min();
  if (denominator == 0 || numerator == min || denominator == min) return std::nullopt;
  const Integer divisor = common_divisor(numerator, denominator) * (denominator < 0 ? -1 : 1);
  Rational result;
  result.numerator_ = numerator / divisor;
  result.denominator_ = denominator / divisor;
  return result;
}

std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
  const Integer floor_a = floor_of(a), floor_b = floor_of(b);
  if (floor_a != floor_b) return floor_a <=> floor_b;
  // The fractions above the floor: (n mod d) / d, compared by the continued fraction of both.
  Integer n_a = a.numerator_ - floor_a * a.denominator_, d_a = a.denominator_;
  Integer n_b = b.numerator_ - floor_b * b.denominator_, d_b = b.denominator_;
  bool is_swapped = false;
  while (n_a != 0 && n_b != 0) {
    const Integer q_a = d_a / n_a, q_b = d_b / n_b;
    if (q_a != q_b) return (q_a < q_b) != is_swapped ? std::strong_ordering::greater : std::strong_ordering::less;
    const Integer rest_a = d_a - q_a * n_a, rest_b = d_b - q_b * n_b;
    d_a = n_a;
    n_a = rest_a;
    d_b = n_b;
    n_b = rest_b;
    is_swapped = !is_swapped;
  }
  if (n_a == 0 && n_b == 0) return std::strong_ordering::equal;
  return (n_a == 0) != is_swapped ? std::strong_ordering::less : std::strong_ordering::greater;
}

std::optional<Rational> product(const Rational& a, const Rational& b) {
  const Integer first = common_divisor(a.numerator(), b.denominator());
  const Integer second = common_divisor(b.numerator(), a.denominator());
  const auto numerator = multiplied(a.numerator() / first, b.numerator() / second);
  const auto denominator = multiplied(a.denominator() / second, b.denominator() / first);
  return numerator && denominator ? Rational::of(*numerator, *denominator) : std::nullopt;
}

std::optional<Rational> quotient(const Rational& a, const Rational& b) {
  const auto inverse = Rational::of(b.denominator(), b.numerator());
  return inverse ? product(a, *inverse) : std::nullopt;
}

std::optional<Rational> sum(const Rational& a, const Rational& b) {
  const Integer divisor = common_divisor(a.denominator(), b.denominator());
  const auto first = multiplied(a.numerator(), b.denominator() / divisor);
  const auto second = multiplied(b.numerator(), a.denominator() / divisor);
  const auto numerator = first && second ? added(*first, *second) : std::nullopt;
  const auto denominator = multiplied(a.denominator(), b.denominator() / divisor);
  return numerator && denominator ? Rational::of(*numerator, *denominator) : std::nullopt;
}

std::optional<Rational> difference(const Rational& a, const Rational& b) { return sum(a, negative(b)); }

std::int64_t floor_of(const Rational& number) {
  const Integer quotient = number.numerator() / number.denominator();
  return number.numerator() < 0 && number.numerator() % number.denominator() != 0 ? quotient - 1 : quotient;
}

std::optional<Rational> parse_rational(std::string_view text) {
  text = trim(text);
  const std::size_t slash = text.find('/');
  const auto numerator = parse_decimal_number(trim(text.substr(0, slash)));
  if (slash == std::string_view::npos || !numerator) return numerator;
  const auto denominator = parse_decimal_number(trim(text.substr(slash + 1)));
  return denominator ? quotient(*numerator, *denominator) : std::nullopt;
}

std::string decimal_text(const Rational& number, unsigned decimals) {
  std::string text = number.numerator() < 0 ? "-" : "";
  const std::uint64_t numerator = magnitude(number.numerator());
  const auto denominator = static_cast<std::uint64_t>(number.denominator());
  std::string integer = fmt::format("{}", numerator / denominator);
  std::uint64_t rest = numerator % denominator;
  if (rest == 0) return text + integer;
  std::uint64_t odd = denominator;
  while (odd % 2 == 0) odd /= 2;
  while (odd % 5 == 0) odd /= 5;
  const bool is_finite = odd == 1;
  std::string fraction;
  while (rest != 0 && (is_finite || fraction.size() < decimals)) {
    // Long division: ten times rest does not fit for large denominators.
    unsigned digit = 0;
    std::uint64_t tenfold = 0;
    for (unsigned i = 0; i < 10; ++i) {
      tenfold += rest;
      if (tenfold >= denominator) {
        tenfold -= denominator;
        ++digit;
      }
    }
    rest = tenfold;
    fraction += static_cast<char>('0' + digit);
  }
  const bool rounds_up = rest != 0 && rest >= denominator - rest;
  for (std::size_t at = fraction.size(); rounds_up && at-- > 0;) {
    if (fraction[at] != '9') {
      ++fraction[at];
      break;
    }
    fraction[at] = '0';
    if (at == 0) integer = fmt::format("{}", numerator / denominator + 1);
  }
  while (fraction.ends_with('0')) fraction.pop_back();
  return text + integer + (fraction.empty() ? "" : "." + fraction);
}

std::string fraction_text(const Rational& number) {
  if (number.is_integer()) return fmt::format("{}", number.numerator());
  return fmt::format("{}/{}", number.numerator(), number.denominator());
}

}  // namespace edsc
