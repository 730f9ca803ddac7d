/// Quantities: integers with a unit and an exact scale. physical value = raw number * scale + offset, in the unit.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <ratio>
#include <string_view>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/constant_errors.hpp"
#include "canopen/base/fraction.hpp"
#include "canopen/base/result.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/unit.hpp"

namespace canopen {

/// The unit of a difference of two values whose unit has an offset: 22 °C - 20 °C is 2 K, not 2 °C.
template <class Unit>
struct DifferenceOf {
  static constexpr UnitRow row = [] {
    UnitRow difference = Unit::row.factor == Fraction{1, 1} ? unit::kelvin::row : Unit::row;
    difference.offset = {};
    return difference;
  }();
};

namespace quantity_detail {

// ---- units ----

template <class Unit>
inline constexpr bool is_difference = false;
template <class Unit>
inline constexpr bool is_difference<DifferenceOf<Unit>> = true;

/// Whether values of a unit are points on a scale whose zero is arbitrary: °C and °F.
template <class Unit>
inline constexpr bool is_point = Unit::row.offset.numerator != 0;

template <class One, class Other>
inline constexpr bool same_dimension =
    One::row.dimension == Other::row.dimension &&
    !(is_difference<One> && is_point<Other>)&&!(is_point<One> && is_difference<Other>);
template <class One, class Other>
inline constexpr bool exact_between = is_exact_conversion(One::row, Other::row);

// ---- literals ----

struct Digits {
  std::int64_t number = 0;
  std::int64_t divisor = 1;
  bool good = true;
};
/// Reads the digits of a literal. An overflow is not a constant expression.
template <char... Characters>
[[nodiscard]] constexpr Digits read_digits() {
  Digits value;
  bool after_point = false;
  for (const char character : {Characters...}) {
    if (character == '\'') continue;
    if (character == '.') {
      after_point = true;
    } else {
      if (character < '0' || character > '9') value.good = false;
      value.number = value.number * 10 + (character - '0');
      if (after_point) value.divisor *= 10;
    }
  }
  return value;
}
template <class Unit, char... Characters>
[[nodiscard]] constexpr auto literal() {
  constexpr Digits digits = read_digits<Characters...>();
  static_assert(digits.good, "a literal with a unit has decimal digits and at most one point");
  constexpr Fraction value{digits.number, digits.divisor};
  return Constant<Unit, value.numerator, value.denominator>{};
}

// ---- text for messages ----

struct Decimal {
  char text[48] = {};
  std::size_t size = 0;

  constexpr void put(char character) { text[size++] = character; }
};
/// Returns a fraction with up to six decimals, and its unit as in a literal.
[[nodiscard]] constexpr Decimal decimal(Fraction value, std::string_view literal) {
  Decimal result;
  if (value.numerator < 0) result.put('-');
  std::int64_t rest = value.numerator < 0 ? -value.numerator : value.numerator;
  char digits[20] = {};
  std::size_t count = 0;
  for (std::int64_t whole = rest / value.denominator; whole != 0 || count == 0; whole /= 10)
    digits[count++] = static_cast<char>('0' + whole % 10);
  while (count != 0) result.put(digits[--count]);
  rest %= value.denominator;
  if (rest != 0) result.put('.');
  for (int i = 0; i < 6 && rest != 0; ++i) {
    rest *= 10;
    result.put(static_cast<char>('0' + rest / value.denominator));
    rest %= value.denominator;
  }
  result.put('_');
  for (const char character : literal) result.put(character);
  return result;
}
template <class Unit, std::int64_t Numerator, std::int64_t Denominator>
struct PhysicalText {
  static constexpr Decimal of = decimal({Numerator, Denominator}, Unit::row.literal);
  template <std::size_t... Position>
  static Text<of.text[Position]...> make(std::index_sequence<Position...>);
  using type = decltype(make(std::make_index_sequence<of.size>{}));
};

// ---- constants ----

template <class Type>
struct FractionOf;
template <class Unit, std::int64_t Numerator, std::int64_t Denominator>
struct FractionOf<Constant<Unit, Numerator, Denominator>> {
  static constexpr Fraction value{Numerator, Denominator};
};

/// An integer of 64 bits, or the nearest one to a larger number of UNSIGNED64.
template <class Number>
[[nodiscard]] constexpr std::int64_t saturated(Number number) {
  constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
  return std::cmp_greater(number, highest) ? highest : static_cast<std::int64_t>(number);
}

template <class QuantityType, class For, class ConstantType>
struct Fitting {
  using Number = typename QuantityType::raw_type;
  using Unit = typename QuantityType::unit;
  using ConstantUnit = typename ConstantType::unit;
  static constexpr bool is_comparable = same_dimension<Unit, ConstantUnit>;
  static constexpr bool is_exact = exact_between<Unit, ConstantUnit>;
  static constexpr bool rises = QuantityType::scale::num > 0;

  static constexpr Fraction raw = [] {
    if constexpr (!is_comparable || !is_exact) {
      return Fraction{};
    } else {
      const Fraction value = convert(FractionOf<ConstantType>::value, ConstantUnit::row, Unit::row);
      return (value - Fraction::of<typename QuantityType::offset>()) / Fraction::of<typename QuantityType::scale>();
    }
  }();
  static constexpr std::int64_t floor = raw.floor();
  static constexpr std::int64_t ceiling = raw.is_whole() ? floor : floor + 1;
  static constexpr std::int64_t lowest = [] {
    if constexpr (requires { For::index; }) return saturated(low_limit<For>());
    return saturated(std::numeric_limits<Number>::lowest());
  }();
  static constexpr std::int64_t highest = [] {
    if constexpr (requires { For::index; }) return saturated(high_limit<For>());
    return saturated(std::numeric_limits<Number>::max());
  }();
  static constexpr Fit result = !is_comparable      ? Fit::other_dimension
                                : !is_exact         ? Fit::not_exact
                                : ceiling > highest ? (rises ? Fit::above : Fit::below)
                                : floor < lowest    ? (rises ? Fit::below : Fit::above)
                                : !raw.is_whole()   ? Fit::between
                                                    : Fit::fits;
  static constexpr Number number = static_cast<Number>(floor);

  template <std::int64_t Of>
  struct Physical {
    static constexpr Fraction value =
        Fraction{Of, 1} * Fraction::of<typename QuantityType::scale>() + Fraction::of<typename QuantityType::offset>();
    using type = typename PhysicalText<Unit, value.numerator, value.denominator>::type;
  };
  /// The nearest accepted value, as text; between two values, the other one too.
  using Nearest = typename Physical<(ceiling > highest ? highest
                                     : floor < lowest  ? lowest
                                     : rises           ? floor
                                                       : ceiling)>::type;
  using Next = typename Physical<(rises ? ceiling : floor)>::type;
};

// ---- conversions ----

/// A line through raw numbers: (raw * factor + summand) / divisor.
struct Line {
  std::int64_t factor;
  std::int64_t summand;
  std::int64_t divisor;
};

/// The line from the raw numbers of a quantity to its values in a unit.
template <class QuantityType, class Unit>
[[nodiscard]] constexpr Line line_to() {
  using Own = typename QuantityType::unit;
  const Fraction at_zero = convert(Fraction::of<typename QuantityType::offset>(), Own::row, Unit::row);
  const Fraction slope = Fraction::of<typename QuantityType::scale>() * Own::row.factor / Unit::row.factor;
  const std::int64_t common = std::lcm(at_zero.denominator, slope.denominator);
  return {slope.numerator * (common / slope.denominator), at_zero.numerator * (common / at_zero.denominator), common};
}

template <class Integer>
[[nodiscard]] constexpr Integer divide_rounding_down(Integer dividend, Integer divisor) {
  return (dividend - (dividend < 0 ? divisor - 1 : 0)) / divisor;
}

[[nodiscard]] constexpr std::int64_t magnitude(std::int64_t number) { return number < 0 ? -number : number; }

/// Whether raw * factor + summand of each raw number of `Bits` bits fits into an integer.
template <class Integer>
[[nodiscard]] constexpr bool is_wide_enough(unsigned bits, std::int64_t factor, std::int64_t summand) {
  constexpr std::int64_t quarter = std::numeric_limits<Integer>::max() / 4;
  if (magnitude(summand) > quarter) return false;
  return factor == 1 || factor == -1 ? bits <= sizeof(Integer) * 8
                                     : bits < sizeof(Integer) * 8 && magnitude(factor) <= (quarter >> (bits - 1));
}

}  // namespace quantity_detail

template <class Number, class Unit, class Scale = std::ratio<1>, class Offset = std::ratio<0>>
struct Quantity {
  using raw_type = Number;
  using unit = Unit;
  using scale = Scale;
  using offset = Offset;
  static_assert(std::integral<Number> && Scale::num != 0);

  constexpr Quantity() = default;
  constexpr explicit Quantity(RawNumber<Number> value) : number_{value.number} {}

  /// A constant that is a value of this quantity, in any unit of its dimension: `position = 0.5_rev`.
  template <class ConstantUnit, std::int64_t Numerator, std::int64_t Denominator>
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr Quantity(Constant<ConstantUnit, Numerator, Denominator>) {
    using Found = quantity_detail::Fitting<Quantity, Quantity, Constant<ConstantUnit, Numerator, Denominator>>;
    if constexpr (Found::result == quantity_detail::Fit::fits) {
      number_ = Found::number;
    } else if constexpr (Found::result == quantity_detail::Fit::between) {
      constant_error::between<Quantity, typename Found::Nearest, typename Found::Next>();
    } else if constexpr (Found::result == quantity_detail::Fit::above) {
      constant_error::above<Quantity, typename Found::Nearest>();
    } else if constexpr (Found::result == quantity_detail::Fit::below) {
      constant_error::below<Quantity, typename Found::Nearest>();
    } else if constexpr (Found::result == quantity_detail::Fit::not_exact) {
      constant_error::not_exact<Quantity, ConstantUnit>();
    } else {
      constant_error::other_dimension<Quantity, ConstantUnit>();
    }
  }

  /// Returns the quantity with the value of another one of the same unit, scale and offset, such as a sum, which has
  /// more bits; value_too_high or value_too_low if it does not fit.
  template <std::integral Other>
  [[nodiscard]] static constexpr Result<Quantity> from(Quantity<Other, Unit, Scale, Offset> value) {
    if (std::cmp_greater(value.number_, std::numeric_limits<Number>::max())) return AbortCode::value_too_high;
    if (std::cmp_less(value.number_, std::numeric_limits<Number>::lowest())) return AbortCode::value_too_low;
    return Quantity{RawNumber<Number>{static_cast<Number>(value.number_)}};
  }
  /// The same with the highest or lowest value in place of one that does not fit.
  template <std::integral Other>
  [[nodiscard]] static constexpr Quantity clamped(Quantity<Other, Unit, Scale, Offset> value) {
    Number number = static_cast<Number>(value.number_);
    if (std::cmp_greater(value.number_, std::numeric_limits<Number>::max()))
      number = std::numeric_limits<Number>::max();
    if (std::cmp_less(value.number_, std::numeric_limits<Number>::lowest()))
      number = std::numeric_limits<Number>::lowest();
    return Quantity{RawNumber<Number>{number}};
  }

  [[nodiscard]] constexpr Number raw() const { return number_; }

  /// Returns the value in a unit as a floating-point number.
  template <class In = Unit>
  [[nodiscard]] constexpr double in() const {
    if constexpr (!quantity_detail::same_dimension<Unit, In>) {
      constant_error::other_dimension<Quantity, In>();
      return 0;
    } else {
      constexpr quantity_detail::Line line = quantity_detail::line_to<Quantity, In>();
      return (static_cast<double>(number_) * static_cast<double>(line.factor) + static_cast<double>(line.summand)) /
             static_cast<double>(line.divisor);
    }
  }

  /// Returns the value as a number of steps of a unit, rounded to the nearest one: `count<unit::kelvin>()` in K,
  /// `count<unit::kelvin, std::ratio<1, 100>>()` in hundredths of K. Uses integers only.
  template <class In = Unit, class Step = std::ratio<1>>
  [[nodiscard]] constexpr auto count() const {
    if constexpr (!quantity_detail::same_dimension<Unit, In>) {
      constant_error::other_dimension<Quantity, In>();
      return std::int32_t{0};
    } else {
      // nearest(x) = floor(x + 1/2). The rest of the summand below the divisor cannot change the result: the dividend
      // is a multiple of the common divisor.
      constexpr quantity_detail::Line line = quantity_detail::line_to<Quantity, In>();
      constexpr Fraction factor = Fraction{line.factor, line.divisor} / Fraction::of<Step>();
      constexpr Fraction summand = Fraction{line.summand, line.divisor} / Fraction::of<Step>() + Fraction{1, 2};
      constexpr std::int64_t whole = (summand * Fraction{factor.denominator, 1}).floor();
      constexpr unsigned bits = sizeof(Number) * 8 + (std::is_signed_v<Number> ? 0 : 1);
      if constexpr (quantity_detail::is_wide_enough<std::int32_t>(bits, factor.numerator, whole) &&
                    quantity_detail::is_wide_enough<std::int32_t>(1, 0, factor.denominator)) {
        return quantity_detail::divide_rounding_down(
            static_cast<std::int32_t>(number_ * static_cast<std::int32_t>(factor.numerator) +
                                      static_cast<std::int32_t>(whole)),
            static_cast<std::int32_t>(factor.denominator));
      } else if constexpr (quantity_detail::is_wide_enough<std::int64_t>(sizeof(Number) * 8, factor.numerator, whole)) {
        return quantity_detail::divide_rounding_down(static_cast<std::int64_t>(number_) * factor.numerator + whole,
                                                     factor.denominator);
      } else {
        constant_error::too_wide<Quantity, In>();
        return std::int64_t{0};
      }
    }
  }

  /// Returns the value that is nearest to a number of steps of a unit, the inverse of `count`:
  /// `rounded<unit::kelvin>(295)` of K, `rounded<unit::kelvin, std::ratio<1, 100>>(29515)` of hundredths of K. A number
  /// halfway between two values gives the one with the higher raw number. value_too_high or value_too_low if the raw
  /// number does not fit. Uses integers only; `count` has at most 32 bits.
  template <class In = Unit, class Step = std::ratio<1>, std::integral Count>
  [[nodiscard]] static constexpr Result<Quantity> rounded(Count count) {
    if constexpr (!quantity_detail::same_dimension<Unit, In>) {
      constant_error::other_dimension<Quantity, In>();
      return Quantity{};
    } else {
      // As in count(): nearest(x) = floor(x + 1/2).
      constexpr Fraction own_scale = Fraction::of<Scale>();
      constexpr Fraction factor = Fraction::of<Step>() * In::row.factor / Unit::row.factor / own_scale;
      constexpr Fraction at_zero = convert(Fraction{0, 1}, In::row, Unit::row);
      constexpr Fraction summand = (at_zero - Fraction::of<Offset>()) / own_scale + Fraction{1, 2};
      constexpr std::int64_t whole = (summand * Fraction{factor.denominator, 1}).floor();
      if constexpr (sizeof(Count) <= 4 &&
                    quantity_detail::is_wide_enough<std::int64_t>(sizeof(Count) * 8, factor.numerator, whole)) {
        const std::int64_t number = quantity_detail::divide_rounding_down(
            static_cast<std::int64_t>(count) * factor.numerator + whole, factor.denominator);
        if (std::cmp_greater(number, std::numeric_limits<Number>::max())) return AbortCode::value_too_high;
        if (std::cmp_less(number, std::numeric_limits<Number>::lowest())) return AbortCode::value_too_low;
        return Quantity{RawNumber<Number>{static_cast<Number>(number)}};
      } else {
        constant_error::too_wide<Quantity, In>();
        return Quantity{};
      }
    }
  }

  Number number_{};  ///< public, for template arguments
};

namespace quantity_detail {

// ---- comparisons ----

template <std::int64_t Bound, class Number>
[[nodiscard]] constexpr bool is_below(Number number) {
  if constexpr (std::cmp_less_equal(Bound, std::numeric_limits<Number>::lowest())) {
    return false;
  } else if constexpr (std::cmp_greater(Bound, std::numeric_limits<Number>::max())) {
    return true;
  } else {
    return number < static_cast<Number>(Bound);
  }
}
template <std::int64_t Bound, class Number>
[[nodiscard]] constexpr bool is_above(Number number) {
  if constexpr (std::cmp_greater_equal(Bound, std::numeric_limits<Number>::max())) {
    return false;
  } else if constexpr (std::cmp_less(Bound, std::numeric_limits<Number>::lowest())) {
    return true;
  } else {
    return number > static_cast<Number>(Bound);
  }
}

/// Two quantities on one scale: `left` steps of the first one, `right` steps of the second one, and `offset` steps
/// between their zeros.
template <class First, class Second>
struct OnOneScale {
  using FirstUnit = typename First::unit;
  using SecondUnit = typename Second::unit;
  static constexpr Fraction first = Fraction::of<typename First::scale>() * FirstUnit::row.factor;
  static constexpr Fraction second = Fraction::of<typename Second::scale>() * SecondUnit::row.factor;
  /// In the base unit.
  static constexpr Fraction step{std::gcd(first.numerator * second.denominator, second.numerator* first.denominator),
                                 first.denominator* second.denominator};
  static constexpr std::int64_t left = (first / step).numerator;
  static constexpr std::int64_t right = (second / step).numerator;
  static constexpr Fraction offset =
      (convert(Fraction::of<typename First::offset>(), FirstUnit::row, FirstUnit::row) * FirstUnit::row.factor +
       FirstUnit::row.offset - Fraction::of<typename Second::offset>() * SecondUnit::row.factor -
       SecondUnit::row.offset) /
      step;

  static constexpr unsigned bits = sizeof(typename First::raw_type) > sizeof(typename Second::raw_type)
                                       ? sizeof(typename First::raw_type) * 8
                                       : sizeof(typename Second::raw_type) * 8;
  static constexpr bool is_small = bits <= 16 && magnitude(left) < 0x2000 && magnitude(right) < 0x2000;
  using Number = std::conditional_t<is_small, std::int32_t, std::int64_t>;
  static constexpr bool is_wide_enough =
      is_small || (magnitude(left) == 1 && magnitude(right) == 1) ||
      (bits <= 32 && magnitude(left) < 0x2000'0000 && magnitude(right) < 0x2000'0000);

  [[nodiscard]] static constexpr Number difference(First one, Second other) {
    return static_cast<Number>(static_cast<Number>(one.raw()) * static_cast<Number>(left) -
                               static_cast<Number>(other.raw()) * static_cast<Number>(right));
  }
  [[nodiscard]] static constexpr Number sum(First one, Second other) {
    return static_cast<Number>(static_cast<Number>(one.raw()) * static_cast<Number>(left) +
                               static_cast<Number>(other.raw()) * static_cast<Number>(right));
  }
};

/// What can be compared with a quantity, and what is wrong with it.
enum class Pair { good, number, others, not_exact, too_wide };

template <class Left, class Right>
[[nodiscard]] constexpr Pair pair_of() {
  if constexpr (std::is_same_v<Left, Right>) {
    return Pair::good;
  } else if constexpr (std::is_arithmetic_v<Left> || std::is_arithmetic_v<Right>) {
    return Pair::number;
  } else if constexpr ((is_quantity<Left> || is_constant<Left>)&&(is_quantity<Right> || is_constant<Right>)) {
    if constexpr (!same_dimension<typename Left::unit, typename Right::unit>) {
      return Pair::others;
    } else if constexpr (!exact_between<typename Left::unit, typename Right::unit>) {
      return Pair::not_exact;
    } else if constexpr (is_quantity<Left> && is_quantity<Right>) {
      return sizeof(typename Left::raw_type) <= 4 && sizeof(typename Right::raw_type) <= 4 &&
                     OnOneScale<Left, Right>::is_wide_enough
                 ? Pair::good
                 : Pair::too_wide;
    } else {
      return Pair::good;
    }
  } else {
    return Pair::others;
  }
}

/// Whether left < right. A constant may be between two values: `temperature < 300_K` is true below 26.85 °C.
template <class Left, class Right>
[[nodiscard]] constexpr bool is_less([[maybe_unused]] const Left& left, [[maybe_unused]] const Right& right) {
  if constexpr (std::is_same_v<Left, Right>) {
    return Left::scale::num > 0 ? left.raw() < right.raw() : right.raw() < left.raw();
  } else if constexpr (is_constant<Right>) {
    using Found = Fitting<Left, Left, Right>;
    if constexpr (Found::rises) {
      return is_below<Found::ceiling>(left.raw());
    } else {
      return is_above<Found::floor>(left.raw());
    }
  } else if constexpr (is_constant<Left>) {
    using Found = Fitting<Right, Right, Left>;
    if constexpr (Found::rises) {
      return is_above<Found::floor>(right.raw());
    } else {
      return is_below<Found::ceiling>(right.raw());
    }
  } else {
    constexpr Fraction bound = Fraction{} - OnOneScale<Left, Right>::offset;
    constexpr std::int64_t ceiling = bound.is_whole() ? bound.floor() : bound.floor() + 1;
    return is_below<ceiling>(OnOneScale<Left, Right>::difference(left, right));
  }
}

template <class Left, class Right>
[[nodiscard]] constexpr bool is_equal(const Left& left, const Right& right) {
  if constexpr (std::is_same_v<Left, Right>) {
    return left.raw() == right.raw();
  } else {
    constexpr Fraction bound = Fraction{} - OnOneScale<Left, Right>::offset;
    return bound.is_whole() && OnOneScale<Left, Right>::difference(left, right) == bound.floor();
  }
}

}  // namespace quantity_detail

template <class Left, class Right>
concept QuantityAmong = is_quantity<Left> || is_quantity<Right>;

// One template for each operator, which accepts everything: what cannot be compared is a failed assertion, not a list
// of candidates. Each calls the assertion itself: see base/constant_errors.hpp.
template <class Left, class Right>
requires QuantityAmong<Left, Right>
[[nodiscard]] constexpr bool operator<(const Left& left, const Right& right) {
  constexpr quantity_detail::Pair pair = quantity_detail::pair_of<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::good) return quantity_detail::is_less(left, right);
  if constexpr (pair == quantity_detail::Pair::number) constant_error::number_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::others) constant_error::others_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::too_wide) constant_error::too_wide<Left, Right>();
  return false;
}
template <class Left, class Right>
requires QuantityAmong<Left, Right>
[[nodiscard]] constexpr bool operator>(const Left& left, const Right& right) {
  constexpr quantity_detail::Pair pair = quantity_detail::pair_of<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::good) return quantity_detail::is_less(right, left);
  if constexpr (pair == quantity_detail::Pair::number) constant_error::number_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::others) constant_error::others_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::too_wide) constant_error::too_wide<Left, Right>();
  return false;
}
template <class Left, class Right>
requires QuantityAmong<Left, Right>
[[nodiscard]] constexpr bool operator<=(const Left& left, const Right& right) {
  constexpr quantity_detail::Pair pair = quantity_detail::pair_of<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::good) return !quantity_detail::is_less(right, left);
  if constexpr (pair == quantity_detail::Pair::number) constant_error::number_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::others) constant_error::others_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::too_wide) constant_error::too_wide<Left, Right>();
  return false;
}
template <class Left, class Right>
requires QuantityAmong<Left, Right>
[[nodiscard]] constexpr bool operator>=(const Left& left, const Right& right) {
  constexpr quantity_detail::Pair pair = quantity_detail::pair_of<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::good) return !quantity_detail::is_less(left, right);
  if constexpr (pair == quantity_detail::Pair::number) constant_error::number_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::others) constant_error::others_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::too_wide) constant_error::too_wide<Left, Right>();
  return false;
}
/// A constant that is not a value of the quantity does not compile: it would never be equal.
template <class Left, class Right>
requires is_quantity<Left>
[[nodiscard]] constexpr bool operator==(const Left& left, [[maybe_unused]] const Right& right) {
  constexpr quantity_detail::Pair pair = quantity_detail::pair_of<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::good && is_constant<Right>) {
    using Found = quantity_detail::Fitting<Left, Left, Right>;
    if constexpr (Found::result == quantity_detail::Fit::fits) return left.raw() == Found::number;
    if constexpr (Found::result == quantity_detail::Fit::above) constant_error::above<Left, typename Found::Nearest>();
    if constexpr (Found::result == quantity_detail::Fit::below) constant_error::below<Left, typename Found::Nearest>();
    if constexpr (Found::result == quantity_detail::Fit::between)
      constant_error::between<Left, typename Found::Nearest, typename Found::Next>();
  } else if constexpr (pair == quantity_detail::Pair::good) {
    return quantity_detail::is_equal(left, right);
  }
  if constexpr (pair == quantity_detail::Pair::number) constant_error::number_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::others) constant_error::others_compared<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (pair == quantity_detail::Pair::too_wide) constant_error::too_wide<Left, Right>();
  return false;
}

namespace quantity_detail {

// ---- sums and differences ----

/// A constant as a quantity whose raw number is 1. One that is added to a temperature is a difference.
template <class ConstantType, class Unit>
struct AsQuantity {
  static constexpr Fraction scale = FractionOf<ConstantType>::value * ConstantType::unit::row.factor / Unit::row.factor;
  using type = Quantity<std::int8_t, std::conditional_t<is_point<Unit>, DifferenceOf<Unit>, Unit>,
                        std::ratio<scale.numerator, scale.denominator>>;
};

enum class Sum { good, number, others, points, not_exact, too_wide };

template <bool IsDifference, class Left, class Right>
[[nodiscard]] constexpr Sum sum_of() {
  if constexpr (std::is_arithmetic_v<Right>) {
    return Sum::number;
  } else if constexpr (is_constant<Right>) {
    using Unit = typename Left::unit;
    using Other = typename Right::unit;
    if constexpr (Unit::row.dimension != Other::row.dimension) return Sum::others;
    if constexpr (!exact_between<Unit, Other>) return Sum::not_exact;
    if constexpr (is_point<Other>) return Sum::points;
    if constexpr (FractionOf<Right>::value.numerator == 0) return Sum::good;
    return Sum::good;
  } else if constexpr (!is_quantity<Right>) {
    return Sum::others;
  } else {
    using Unit = typename Left::unit;
    using Other = typename Right::unit;
    if constexpr (Unit::row.dimension != Other::row.dimension) return Sum::others;
    if constexpr (!exact_between<Unit, Other>) return Sum::not_exact;
    constexpr bool adds_difference = !is_point<Other> && (!is_point<Unit> || is_difference<Other>);
    constexpr bool is_of_points = IsDifference && is_point<Unit> && is_point<Other>;
    if constexpr (!adds_difference && !is_of_points) return Sum::points;
    return OnOneScale<Left, Right>::is_wide_enough ? Sum::good : Sum::too_wide;
  }
}

/// The quantity of a sum or difference: on the scale on which both are whole numbers, with 32 bits if both have 16 at
/// most, otherwise with 64.
template <bool IsDifference, class Left, class Right>
struct SumQuantity {
  using Scale = OnOneScale<Left, Right>;
  using Unit = typename Left::unit;
  using Result = std::conditional_t<is_point<Unit> && is_point<typename Right::unit>, DifferenceOf<Unit>, Unit>;
  static constexpr Fraction scale = Scale::step / Unit::row.factor;
  static constexpr Fraction offset = [] {
    const Fraction own = Fraction::of<typename Left::offset>();
    const Fraction other = Fraction::of<typename Right::offset>() * Right::unit::row.factor / Unit::row.factor;
    if (!IsDifference) return own + other;
    const Fraction zeros = (Unit::row.offset - Right::unit::row.offset) / Unit::row.factor;
    return is_difference<Result> && is_point<Unit> ? own - other + zeros : own - other;
  }();
  using type = Quantity<typename Scale::Number, Result, std::ratio<scale.numerator, scale.denominator>,
                        std::ratio<offset.numerator, offset.denominator>>;
};

template <bool IsDifference, class Left, class Right>
[[nodiscard]] constexpr auto add(const Left& left, const Right& right) {
  if constexpr (is_constant<Right>) {
    if constexpr (FractionOf<Right>::value.numerator == 0) {
      return left;
    } else {
      using Added = typename AsQuantity<Right, typename Left::unit>::type;
      return add<IsDifference>(left, Added{RawNumber<std::int8_t>{1}});
    }
  } else {
    using Type = typename SumQuantity<IsDifference, Left, Right>::type;
    using Scale = OnOneScale<Left, Right>;
    const auto number = IsDifference ? Scale::difference(left, right) : Scale::sum(left, right);
    return Type{RawNumber<typename Type::raw_type>{number}};
  }
}

}  // namespace quantity_detail

/// The sum of two values of one dimension. To a temperature in °C or °F, a difference is added: `t + 0.5_K`.
template <class Left, class Right>
requires is_quantity<Left>
[[nodiscard]] constexpr auto operator+(const Left& left, [[maybe_unused]] const Right& right) {
  constexpr quantity_detail::Sum sum = quantity_detail::sum_of<false, Left, Right>();
  if constexpr (sum == quantity_detail::Sum::good) return quantity_detail::add<false>(left, right);
  if constexpr (sum == quantity_detail::Sum::number) constant_error::number_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::others) constant_error::others_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::points) constant_error::points_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::too_wide) constant_error::too_wide<Left, Right>();
  if constexpr (sum != quantity_detail::Sum::good) return left;
}
/// The difference of two values of one dimension. That of two temperatures in °C is in K, without the offset of °C.
template <class Left, class Right>
requires is_quantity<Left>
[[nodiscard]] constexpr auto operator-(const Left& left, [[maybe_unused]] const Right& right) {
  constexpr quantity_detail::Sum sum = quantity_detail::sum_of<true, Left, Right>();
  if constexpr (sum == quantity_detail::Sum::good) return quantity_detail::add<true>(left, right);
  if constexpr (sum == quantity_detail::Sum::number) constant_error::number_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::others) constant_error::others_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::points) constant_error::points_added<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::not_exact) constant_error::not_exact<Left, Right>();
  if constexpr (sum == quantity_detail::Sum::too_wide) constant_error::too_wide<Left, Right>();
  if constexpr (sum != quantity_detail::Sum::good) return left;
}

/// `using namespace canopen::literals;` - constants with a unit: `21.5_degC`, `3'000_rpm`, `50_percent`. od/unit.hpp
/// lists them.
namespace literals {

// clang-format off
#define CANOPEN_UNIT(name, suffix, ...)                                                                   \
  template <char... Characters>                                                                           \
  [[nodiscard]] constexpr auto operator""_##suffix() { return quantity_detail::literal<unit::name, Characters...>(); }
CANOPEN_UNITS(CANOPEN_UNIT)
#undef CANOPEN_UNIT
// clang-format on

}  // namespace literals
}  // namespace canopen
