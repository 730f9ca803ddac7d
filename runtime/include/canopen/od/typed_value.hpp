/// Values with a meaning: words of fields, enumerations and quantities (od/quantity.hpp). Each has exactly the bytes of
/// its raw number: the object store, SDO and PDO transfer bytes as for a number.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/constant_errors.hpp"

namespace canopen {

// ---- raw numbers ----

namespace typed_value_detail {

template <class Type>
struct RawNumberOf {
  using type = Type;
};
template <class Type>
requires std::is_enum_v<Type>
struct RawNumberOf<Type> {
  using type = std::underlying_type_t<Type>;
};
template <class Type>
requires requires { typename Type::raw_type; }
struct RawNumberOf<Type> {
  using type = typename Type::raw_type;
};

}  // namespace typed_value_detail

/// The type of the raw number of an enumeration, a word of fields or a quantity; any other type itself.
template <class Type>
using RawOf = typename typed_value_detail::RawNumberOf<Type>::type;

/// An enumeration, a word of fields or a quantity.
template <class Type>
concept Meaningful = !std::same_as<RawOf<Type>, Type>;

/// A number that its author declares as the raw number of an object: `set(od::setpoint{}, canopen::raw(215))`.
template <class Number>
struct RawNumber {
  Number number;
};
template <class Number>
requires std::is_arithmetic_v<Number>
[[nodiscard]] constexpr RawNumber<Number> raw(Number number) { return {number}; }

template <class Type>
inline constexpr bool is_raw_number = false;
template <class Number>
inline constexpr bool is_raw_number<RawNumber<Number>> = true;

/// Returns the raw number of a value; a number, a string or a time itself.
template <class Type>
[[nodiscard]] constexpr decltype(auto) to_raw(const Type& value) {
  if constexpr (std::is_enum_v<Type>) {
    return static_cast<RawOf<Type>>(value);
  } else if constexpr (Meaningful<Type>) {
    return RawOf<Type>{value.number_};
  } else if constexpr (std::is_arithmetic_v<Type>) {
    return Type{value};
  } else {
    return (value);
  }
}

/// Returns the value with a raw number.
template <class Type>
[[nodiscard]] constexpr Type from_raw(const RawOf<Type>& number) {
  if constexpr (std::is_enum_v<Type>) {
    return static_cast<Type>(number);
  } else if constexpr (Meaningful<Type>) {
    return Type{RawNumber<RawOf<Type>>{number}};
  } else {
    return number;
  }
}

// ---- words of fields ----

template <unsigned Bits>
struct FieldNumber;

/// Returns a number for a field: the highest one of the field instead of a number above it.
struct Clamped {
  std::uint64_t number;
};
[[nodiscard]] constexpr Clamped clamped(std::uint64_t number) { return {number}; }
/// Returns a number for a field: those low bits of it that the field has.
struct LowBits {
  std::uint64_t number;
};
[[nodiscard]] constexpr LowBits low_bits(std::uint64_t number) { return {number}; }

/// A number for a field of `Bits` bits. A constant outside its range does not compile; what becomes of a variable
/// outside of it is stated: `word.zone(canopen::clamped(n))` or `word.zone(canopen::low_bits(n))`.
template <unsigned Bits>
struct FieldNumber {
  using Number = std::conditional_t<(Bits > 32), std::uint64_t, std::uint32_t>;
  static constexpr Number highest = static_cast<Number>(~Number{0} >> (sizeof(Number) * 8 - Bits));

  template <std::integral Constant>
  // NOLINTNEXTLINE(google-explicit-constructor): `word.zone(3)` converts the number
  consteval FieldNumber(Constant constant) : number{static_cast<Number>(constant)} {
    const bool is_outside = std::cmp_less(constant, 0) || std::cmp_greater(constant, highest);
    if (constant_error::constant_is_outside_the_range_of_the_field<Bits>[is_outside ? 1 : 0]) number = 0;
  }
  constexpr FieldNumber(Clamped any)  // NOLINT(google-explicit-constructor)
      : number{any.number > highest ? highest : static_cast<Number>(any.number)} {}
  constexpr FieldNumber(LowBits any)  // NOLINT(google-explicit-constructor)
      : number{static_cast<Number>(any.number) & highest} {}

  Number number;
};

/// The same for a field of up to 32 bits with a sign.
template <unsigned Bits>
struct SignedFieldNumber {
  static constexpr std::int32_t highest = static_cast<std::int32_t>((std::uint32_t{1} << (Bits - 1)) - 1);
  static constexpr std::int32_t lowest = -highest - 1;

  template <std::integral Constant>
  // NOLINTNEXTLINE(google-explicit-constructor): `word.trim(-1)` converts the number
  consteval SignedFieldNumber(Constant constant) : number{static_cast<std::int32_t>(constant)} {
    const bool is_outside = std::cmp_less(constant, lowest) || std::cmp_greater(constant, highest);
    if (constant_error::constant_is_outside_the_range_of_the_field<Bits>[is_outside ? 1 : 0]) number = 0;
  }
  constexpr SignedFieldNumber(LowBits any)  // NOLINT(google-explicit-constructor)
      : number{static_cast<std::int32_t>(any.number)} {}

  std::int32_t number;
};

/// Base of a word of fields. It depends on the type of the raw number alone: the compiler instantiates it once for all
/// words of a length. A generated word has two functions for each field, with the name of the field.
template <std::unsigned_integral Number>
struct Fields {
  using raw_type = Number;

  constexpr Fields() = default;
  constexpr explicit Fields(RawNumber<Number> value) : number_{value.number} {}
  [[nodiscard]] constexpr Number raw() const { return number_; }

  /// Whether all, or any, of the bits are set that another word has: `word.all(type{}.fault(true).halt(true))`.
  [[nodiscard]] constexpr bool all(Fields bits) const { return (number_ & bits.number_) == bits.number_; }
  [[nodiscard]] constexpr bool any(Fields bits) const { return (number_ & bits.number_) != 0; }

  Number number_{};  ///< public, for template arguments

 protected:
  [[nodiscard]] constexpr bool has_(Number mask) const { return (number_ & mask) != 0; }
  constexpr void assign_(Number mask, bool on) {
    number_ = static_cast<Number>(on ? number_ | mask : number_ & static_cast<Number>(~mask));
  }
  /// `mask`: the ones of the field, shifted to bit 0.
  [[nodiscard]] constexpr Number part_(unsigned shift, Number mask) const {
    return static_cast<Number>(static_cast<Number>(number_ >> shift) & mask);
  }
  constexpr void assign_part_(unsigned shift, Number mask, Number value) {
    const auto others = static_cast<Number>(number_ & static_cast<Number>(~static_cast<Number>(mask << shift)));
    number_ = static_cast<Number>(others | static_cast<Number>(static_cast<Number>(value & mask) << shift));
  }
  /// A field of up to 32 bits with a sign.
  [[nodiscard]] constexpr std::int32_t signed_part_(unsigned shift, unsigned bits) const {
    const auto low = static_cast<std::uint32_t>(number_ >> shift);
    return static_cast<std::int32_t>(low << (32 - bits)) >> (32 - bits);
  }
};

/// A generated word of fields.
template <class Type>
concept FieldWord = requires(Type word) {
  typename Type::raw_type;
  word.number_;
}
&&std::derived_from<Type, Fields<typename Type::raw_type>>;

/// Words of one object are compared; others have the same base.
template <FieldWord Left, class Right>
[[nodiscard]] constexpr bool operator==(const Left& left, [[maybe_unused]] const Right& right) {
  if constexpr (std::is_same_v<Left, Right>) {
    return left.raw() == right.raw();
  } else if constexpr (std::is_arithmetic_v<Right>) {
    constant_error::number_compared<Left, Right>();
    return false;
  } else {
    constant_error::others_compared<Left, Right>();
    return false;
  }
}

// ---- quantities: od/quantity.hpp defines them ----

template <class Number, class Unit, class Scale, class Offset>
struct Quantity;

template <class Type>
inline constexpr bool is_quantity = false;
template <class Number, class Unit, class Scale, class Offset>
inline constexpr bool is_quantity<Quantity<Number, Unit, Scale, Offset>> = true;

/// A constant of the program text, exactly as it is written: `21.5_degC`. Its value is a part of its type, so that it
/// is checked wherever it is converted, and the compiler's message has the nearest values.
template <class UnitType, std::int64_t Numerator, std::int64_t Denominator>
struct Constant {
  using unit = UnitType;
  constexpr Constant<UnitType, -Numerator, Denominator> operator-() const { return {}; }
};

template <class Type>
inline constexpr bool is_constant = false;
template <class Unit, std::int64_t Numerator, std::int64_t Denominator>
inline constexpr bool is_constant<Constant<Unit, Numerator, Denominator>> = true;

namespace quantity_detail {

/// Whether a constant is a value of a quantity, between two of them, or outside the limits.
enum class Fit { fits, between, above, below, other_dimension, not_exact };

/// How a constant fits a quantity, within the limits of `For`: an object or the quantity itself.
template <class QuantityType, class For, class ConstantType>
struct Fitting;

}  // namespace quantity_detail
}  // namespace canopen
