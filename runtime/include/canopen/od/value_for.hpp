/// Values for objects that are known at compile time: which types an object accepts, and its limits.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/constant_errors.hpp"
#include "canopen/base/result.hpp"
#include "canopen/od/accepted_values.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

/// A string object: its value type has a capacity.
template <class ObjectType>
concept StringObject = DictionaryObject<ObjectType> && requires {
  ObjectType::type::capacity();
};

template <class ObjectType>
concept DomainObject = DictionaryObject<ObjectType> && std::same_as<typename ObjectType::type, Domain>;

/// An object whose value is a number, a BOOLEAN or a time.
template <class ObjectType>
concept NumberObject = DictionaryObject<ObjectType> && ObjectType::bits >
0;

namespace value_for_detail {

template <class ValueType>
concept Integer = std::integral<ValueType> && !std::same_as<ValueType, bool> && !std::same_as<ValueType, char>;

template <class ValueType>
concept Number = Integer<ValueType> || std::floating_point<ValueType>;

template <class Type>
struct NumberIn {
  using type = void;
};
template <class Number>
struct NumberIn<RawNumber<Number>> {
  using type = Number;
};

}  // namespace value_for_detail

/// A value that can be written to an object: of the same type, an integer to an integer, any number to a REAL.
template <class ValueType, class ObjectType>
concept ValueFor = NumberObject<ObjectType> &&
    (std::same_as<ValueType, typename ObjectType::type> ||
     (value_for_detail::Integer<ValueType> && value_for_detail::Integer<typename ObjectType::type>) ||
     (value_for_detail::Number<ValueType> && std::floating_point<typename ObjectType::type>));

/// A type whose values all fit into another one: the same type, an integer or REAL that is not wider, or the raw number
/// of a value with a meaning.
template <class ValueType, class Type>
concept FitsInto = std::same_as<ValueType, Type> ||
                   (is_raw_number<ValueType>&& Meaningful<Type>&&
                        std::same_as<typename value_for_detail::NumberIn<ValueType>::type, RawOf<Type>>) ||
                   (value_for_detail::Integer<ValueType> && value_for_detail::Integer<Type> &&
                    std::cmp_greater_equal(std::numeric_limits<ValueType>::min(), std::numeric_limits<Type>::min()) &&
                    std::cmp_less_equal(std::numeric_limits<ValueType>::max(), std::numeric_limits<Type>::max())) ||
                   (std::same_as<ValueType, float> && std::same_as<Type, double>);

/// An object of a closed enumeration: `is_value` is true for the values that it accepts.
template <class ObjectType>
concept ClosedObject = requires(typename ObjectType::type value) {
  { ObjectType::is_value(value) } -> std::same_as<bool>;
};

/// Checks a value against the range of the object's type and its limits: value_too_high, value_too_low, or
/// invalid_value for a NaN written to a REAL with limits, and for a value between the limits that is not accepted. A
/// finite number beyond a REAL32 is too high or too low.
template <NumberObject ObjectType, ValueFor<ObjectType> ValueType>
[[nodiscard]] constexpr AbortCode check_value(ValueType value) {
  using Type = typename ObjectType::type;
  if constexpr (Meaningful<Type>) {
    if constexpr (ClosedObject<ObjectType>) {
      if (!ObjectType::is_value(value)) return AbortCode::invalid_value;
    }
    return check_value<NumbersOf<ObjectType>>(to_raw(value));
  } else if constexpr (value_for_detail::Integer<Type>) {
    if (std::cmp_greater(value, high_limit<ObjectType>())) return AbortCode::value_too_high;
    if (std::cmp_less(value, low_limit<ObjectType>())) return AbortCode::value_too_low;
    if (!accepts<ObjectType>(static_cast<Type>(value))) return AbortCode::invalid_value;
  } else if constexpr (std::floating_point<Type>) {
    if constexpr (sizeof(ValueType) > sizeof(Type) && std::floating_point<ValueType>) {
      constexpr ValueType infinity = std::numeric_limits<ValueType>::infinity();
      if (value > std::numeric_limits<Type>::max() && value != infinity) return AbortCode::value_too_high;
      if (value < std::numeric_limits<Type>::lowest() && value != -infinity) return AbortCode::value_too_low;
    }
    [[maybe_unused]] const auto real = static_cast<Type>(value);
    if constexpr (requires { ObjectType::high_limit; }) {
      if (real != real) return AbortCode::invalid_value;
      if (real > ObjectType::high_limit) return AbortCode::value_too_high;
    }
    if constexpr (requires { ObjectType::low_limit; }) {
      if (real != real) return AbortCode::invalid_value;
      if (real < ObjectType::low_limit) return AbortCode::value_too_low;
    }
  }
  return ok;
}

namespace value_for_detail {

// A constant that an object does not accept reads the element after the only one: the compiler's message has the name
// of the array and that of the object.
template <class ObjectType>
inline constexpr bool constant_is_above_the_high_limit[1] = {};
template <class ObjectType>
inline constexpr bool constant_is_below_the_low_limit[1] = {};
template <class ObjectType>
inline constexpr bool constant_is_not_an_accepted_value[1] = {};

/// The characters of a literal for a string.
template <class Type>
struct CharacterOf {};
template <std::size_t Capacity>
struct CharacterOf<VisibleString<Capacity>> {
  using type = char;
};
template <std::size_t Capacity>
struct CharacterOf<UnicodeString<Capacity>> {
  using type = char16_t;
};

template <class Character, class Type>
concept CharacterFor = std::same_as<Character, typename CharacterOf<Type>::type>;

/// What a string is made of at run time.
template <class Type>
struct TextOf {
  using type = std::basic_string_view<typename CharacterOf<Type>::type>;
};
template <std::size_t Capacity>
struct TextOf<OctetString<Capacity>> {
  using type = std::span<const std::uint8_t>;
};

/// Whether a literal with this number of characters and its terminating zero fits; the arguments are in the compiler's
/// message.
template <class Object, std::size_t Characters>
inline constexpr bool has_room_for = (Characters - 1) * sizeof(typename CharacterOf<typename Object::type>::type) <=
                                     (Object::bits > 0 ? Object::bits / 8u : Object::type::capacity());

/// Whether the code is `wrong`, as the number of an element.
[[nodiscard]] constexpr int element_of(AbortCode code, AbortCode wrong) { return code == wrong ? 1 : 0; }

/// False; the arguments are in the compiler's message.
template <class Object, class Value>
inline constexpr bool has_the_type_of = false;
template <class Object, class Value>
inline constexpr bool is_checked = false;

template <class ValueType>
concept Variable = !std::is_const_v<ValueType>;

}  // namespace value_for_detail

/// Whether an object rejects values of its type: it has limits or a list of values, or uses fewer bits. The limits of
/// an integer may be those of its type; a REAL with limits rejects NaN.
template <DictionaryObject ObjectType>
inline constexpr bool rejects_values = [] {
  using Type = RawOf<typename ObjectType::type>;
  if constexpr (!std::is_arithmetic_v<Type> || std::same_as<Type, bool>) {
    return false;
  } else {
    bool any = requires { ObjectType::accepted; }
    || ClosedObject<ObjectType> || ObjectType::bits < sizeof(Type) * 8;
    if constexpr (requires { ObjectType::low_limit; })
      any = any || !std::is_integral_v<Type> || to_raw(ObjectType::low_limit) != std::numeric_limits<Type>::lowest();
    if constexpr (requires { ObjectType::high_limit; })
      any = any || !std::is_integral_v<Type> || to_raw(ObjectType::high_limit) != std::numeric_limits<Type>::max();
    return any;
  }
}();

/// A value that its object accepts: a constant, which the compiler checks against the type and the limits of the
/// object, or the result of `from`.
///
///     const auto target = canopen::CheckedValue<od::target_position>::from(position);
///     if (target) bus.send(frame_of(drive::Rpdo2::pack(*target)));
template <NumberObject ObjectType>
class CheckedValue {
 public:
  using type = typename ObjectType::type;

  /// Returns value_too_high or value_too_low for a number outside the range or the limits of the object, invalid_value
  /// for one that it does not accept.
  template <ValueFor<ObjectType> ValueType>
  [[nodiscard]] static constexpr Result<CheckedValue> from(ValueType value) {
    if (const AbortCode code = check_value<ObjectType>(value); code != ok) return code;
    CheckedValue checked;
    checked.value_ = static_cast<type>(value);
    return checked;
  }

  template <ValueFor<ObjectType> ValueType>
  // NOLINTNEXTLINE(google-explicit-constructor): `set(od::x{}, 420)` converts the number
  consteval CheckedValue(const ValueType& constant) : value_{static_cast<type>(constant)} {
    using namespace value_for_detail;
    const AbortCode code = check_value<ObjectType>(constant);
    if (constant_is_above_the_high_limit<ObjectType>[element_of(code, AbortCode::value_too_high)]) value_ = {};
    if (constant_is_below_the_low_limit<ObjectType>[element_of(code, AbortCode::value_too_low)]) value_ = {};
    if (constant_is_not_an_accepted_value<ObjectType>[element_of(code, AbortCode::invalid_value)]) value_ = {};
  }
  /// Rejects a variable, which may be outside the limits.
  template <value_for_detail::Variable ValueType>
  requires(ValueFor<ValueType, ObjectType>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr CheckedValue(ValueType&) {
    static_assert(!FitsInto<ValueType, type> || value_for_detail::is_checked<ObjectType, ValueType>,
                  "this variable may be outside the limits of the object: use CheckedValue<...>::from(variable)");
    static_assert(FitsInto<ValueType, type> || value_for_detail::has_the_type_of<ObjectType, ValueType>,
                  "the type of this value is wider than that of the object, or has another sign: check its range, then "
                  "static_cast it");
  }
  /// A value that is not a number for the object.
  template <class ValueType>
  requires(!ValueFor<ValueType, ObjectType>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr CheckedValue(const ValueType&) {
    static_assert(value_for_detail::has_the_type_of<ObjectType, ValueType>,
                  "this value is not of the type of the object");
  }
  [[nodiscard]] constexpr type value() const { return value_; }

 private:
  friend class Result<CheckedValue>;
  constexpr CheckedValue() = default;

  type value_{};
};

/// A value for an object, as the parameter of a function: a value of its type or of a narrower one, or a constant,
/// whose limits the compiler checks. Nothing else compiles: no number is truncated, and none changes its sign.
template <NumberObject ObjectType>
class ValueOf {
 public:
  using type = typename ObjectType::type;

  template <FitsInto<type> ValueType>
  constexpr ValueOf(ValueType value)
      : value_{value} {}  // NOLINT(google-explicit-constructor): `pack(speed)` converts a number
  /// A constant of another type, such as `int`.
  template <ValueFor<ObjectType> ValueType>
  requires(!FitsInto<ValueType, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      consteval ValueOf(const ValueType& constant)
      : value_{static_cast<type>(constant)} {
    using namespace value_for_detail;
    const AbortCode code = check_value<ObjectType>(constant);
    if (constant_is_above_the_high_limit<ObjectType>[element_of(code, AbortCode::value_too_high)]) value_ = {};
    if (constant_is_below_the_low_limit<ObjectType>[element_of(code, AbortCode::value_too_low)]) value_ = {};
    if (constant_is_not_an_accepted_value<ObjectType>[element_of(code, AbortCode::invalid_value)]) value_ = {};
  }
  /// A variable of another type.
  template <value_for_detail::Variable ValueType>
  requires(ValueFor<ValueType, ObjectType> && !FitsInto<ValueType, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ValueOf(ValueType&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<ObjectType, ValueType>,
                  "the type of this value is wider than that of the object, or has another sign: check its range, then "
                  "static_cast it");
  }
  /// A value that is not a number for the object.
  template <class ValueType>
  requires(!ValueFor<ValueType, ObjectType> && !FitsInto<ValueType, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ValueOf(const ValueType&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<ObjectType, ValueType>,
                  "this value is not of the type of the object");
  }

  [[nodiscard]] constexpr type value() const { return value_; }

 private:
  type value_;
};

namespace value_for_detail {

/// A constant with a unit for a quantity, or a value that is not one of an object of this type.
template <class ValueType, class Type>
concept ConstantOrOther = (is_quantity<Type> && is_constant<ValueType>) ||
                          (!FitsInto<ValueType, Type> && !is_raw_number<ValueType>);

}  // namespace value_for_detail

/// A constant with a unit for an object with a meaning, as the parameter of a function.
template <NumberObject ObjectType>
class ConstantOf {
 public:
  using type = typename ObjectType::type;

  /// A constant with a unit: `set(od::setpoint{}, 21.5_degC)`.
  template <class Unit, std::int64_t Numerator, std::int64_t Denominator>
  requires is_quantity<type>
  // NOLINTNEXTLINE(google-explicit-constructor)
  constexpr ConstantOf(Constant<Unit, Numerator, Denominator>) {
    using Found = quantity_detail::Fitting<type, ObjectType, Constant<Unit, Numerator, Denominator>>;
    if constexpr (Found::result == quantity_detail::Fit::fits) {
      value_ = from_raw<type>(Found::number);
    } else if constexpr (Found::result == quantity_detail::Fit::between) {
      constant_error::between<ObjectType, typename Found::Nearest, typename Found::Next>();
    } else if constexpr (Found::result == quantity_detail::Fit::above) {
      constant_error::above<ObjectType, typename Found::Nearest>();
    } else if constexpr (Found::result == quantity_detail::Fit::below) {
      constant_error::below<ObjectType, typename Found::Nearest>();
    } else if constexpr (Found::result == quantity_detail::Fit::not_exact) {
      constant_error::not_exact<ObjectType, Unit>();
    } else {
      constant_error::other_dimension<ObjectType, Unit>();
    }
  }
  /// A value of another type.
  template <class ValueType>
  requires(!FitsInto<ValueType, type> && !is_raw_number<ValueType> && !(is_quantity<type> && is_constant<ValueType>))
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ConstantOf(const ValueType&) {
    if constexpr (std::is_arithmetic_v<ValueType>) {
      constant_error::number<ObjectType, ValueType>();
    } else {
      constant_error::value_of_another<ObjectType, ValueType>();
    }
  }
  [[nodiscard]] constexpr type value() const { return value_; }

 protected:
  constexpr ConstantOf() = default;

  /// Returns a raw number as a value. One that is not accepted is not a constant expression.
  template <class Number>
  [[nodiscard]] static consteval type accepted(RawNumber<Number> constant) {
    using namespace value_for_detail;
    const AbortCode code = check_value<NumbersOf<ObjectType>>(constant.number);
    if (constant_is_above_the_high_limit<ObjectType>[element_of(code, AbortCode::value_too_high)]) return {};
    if (constant_is_below_the_low_limit<ObjectType>[element_of(code, AbortCode::value_too_low)]) return {};
    const type value = from_raw<type>(static_cast<RawOf<type>>(constant.number));
    const bool is_other = check_value<ObjectType>(value) == AbortCode::invalid_value;
    if (constant_is_not_an_accepted_value<ObjectType>[is_other ? 1 : 0]) return {};
    return value;
  }

  type value_{};
};

template <NumberObject ObjectType>
requires Meaningful<typename ObjectType::type>
class CheckedValue<ObjectType> : public ConstantOf<ObjectType> {
 public:
  using type = typename ObjectType::type;

  /// Not inherited: the compiler's message then has the line of the call.
  template <value_for_detail::ConstantOrOther<type> ValueType>
  constexpr CheckedValue(const ValueType& value)  // NOLINT(google-explicit-constructor)
      : ConstantOf<ObjectType>{value} {}
  /// Returns value_too_high, value_too_low or invalid_value for a value that the object does not accept.
  [[nodiscard]] static constexpr Result<CheckedValue> from(type value) {
    if (const AbortCode code = check_value<ObjectType>(value); code != ok) return code;
    CheckedValue checked;
    checked.value_ = value;
    return checked;
  }
  /// The same for a raw number.
  template <class Number>
  [[nodiscard]] static constexpr Result<CheckedValue> from(RawNumber<Number> raw) {
    if (const AbortCode code = check_value<NumbersOf<ObjectType>>(raw.number); code != ok) return code;
    return from(from_raw<type>(static_cast<RawOf<type>>(raw.number)));
  }

  // NOLINTNEXTLINE(google-explicit-constructor): `pack(od::mode::value::homing)` converts the value
  consteval CheckedValue(const type& constant) {
    using namespace value_for_detail;
    const AbortCode code = check_value<ObjectType>(constant);
    if (constant_is_above_the_high_limit<ObjectType>[element_of(code, AbortCode::value_too_high)]) return;
    if (constant_is_below_the_low_limit<ObjectType>[element_of(code, AbortCode::value_too_low)]) return;
    if (constant_is_not_an_accepted_value<ObjectType>[element_of(code, AbortCode::invalid_value)]) return;
    this->value_ = constant;
  }
  /// A raw number: `set(od::setpoint{}, canopen::raw(215))`.
  template <class Number>
  // NOLINTNEXTLINE(google-explicit-constructor)
  consteval CheckedValue(RawNumber<Number> constant) {
    this->value_ = ConstantOf<ObjectType>::accepted(constant);
  }
  /// Rejects a variable, which may be outside the limits.
  template <value_for_detail::Variable ValueType>
  requires(std::same_as<ValueType, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr CheckedValue(ValueType&) {
    static_assert(value_for_detail::is_checked<ObjectType, ValueType>,
                  "this variable may be outside the limits of the object: use CheckedValue<...>::from(variable)");
  }

 private:
  friend class Result<CheckedValue>;
  constexpr CheckedValue() = default;
};

template <NumberObject ObjectType>
requires Meaningful<typename ObjectType::type>
class ValueOf<ObjectType> : public ConstantOf<ObjectType> {
 public:
  using type = typename ObjectType::type;

  /// Not inherited: the compiler's message then has the line of the call.
  template <value_for_detail::ConstantOrOther<type> ValueType>
  constexpr ValueOf(const ValueType& value)  // NOLINT(google-explicit-constructor)
      : ConstantOf<ObjectType>{value} {}
  constexpr ValueOf(const type& value) { this->value_ = value; }  // NOLINT(google-explicit-constructor)
  /// A raw number of the type of the object, which every value of it may be.
  constexpr ValueOf(RawNumber<RawOf<type>> raw) {  // NOLINT(google-explicit-constructor)
    this->value_ = from_raw<type>(raw.number);
  }
  /// A raw number: `set(od::setpoint{}, canopen::raw(215))`.
  template <class Number>
  requires(!std::same_as<Number, RawOf<type>>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      consteval ValueOf(RawNumber<Number> constant) {
    this->value_ = ConstantOf<ObjectType>::accepted(constant);
  }
};

/// A string for an object, as the parameter of a function: a value of its type, or a literal, whose length the compiler
/// checks.
template <StringObject ObjectType>
class StringOf {
 public:
  using type = typename ObjectType::type;

  constexpr StringOf(const StringOf&) = default;
  constexpr StringOf(const type& value) : value_{value} {}  // NOLINT(google-explicit-constructor): a string is one
  template <std::size_t Size, value_for_detail::CharacterFor<type> Character>
  constexpr StringOf(const Character (&literal)[Size]) {  // NOLINT(google-explicit-constructor): a text is one
    static_assert(value_for_detail::has_room_for<ObjectType, Size>,
                  "this text is longer than the string of the object");
    if constexpr (value_for_detail::has_room_for<ObjectType, Size>) value_ = type{literal};
  }
#if defined(__clang__) && __clang_major__ < 16                    // as OctetString
  constexpr StringOf(std::initializer_list<std::uint8_t> octets)  // NOLINT(google-explicit-constructor)
#else
  consteval StringOf(std::initializer_list<std::uint8_t> octets)  // NOLINT(google-explicit-constructor)
#endif
      requires std::constructible_from<type, std::initializer_list<std::uint8_t>> : value_{octets} {
  }
  /// A value that is not a string of the object.
  template <class ValueType>
  requires(!std::is_array_v<ValueType>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr StringOf(const ValueType&) {
    static_assert(value_for_detail::has_the_type_of<ObjectType, ValueType>,
                  "this value is not of the type of the object");
  }

  [[nodiscard]] constexpr const type& value() const { return value_; }

 private:
  type value_{};
};

/// A text whose length is known at run time only.
template <class ValueType, class ObjectType>
concept TextFor =
    StringObject<ObjectType> && !std::is_array_v<ValueType> &&
    std::convertible_to<const ValueType&, typename value_for_detail::TextOf<typename ObjectType::type>::type>;

namespace value_for_detail {

template <class ObjectType>
struct Parameter {
  using type = const typename ObjectType::type&;
};
template <class ObjectType>
requires(
    NumberObject<ObjectType>&& std::is_arithmetic_v<RawOf<typename ObjectType::type>>) struct Parameter<ObjectType> {
  using type = ValueOf<ObjectType>;
};
template <StringObject ObjectType>
struct Parameter<ObjectType> {
  using type = StringOf<ObjectType>;
};

/// Returns the value of an object with this value or raw number.
template <class Type, FitsInto<Type> ValueType>
[[nodiscard]] constexpr Type value_as(ValueType value) {
  if constexpr (is_raw_number<ValueType>) {
    return from_raw<Type>(value.number);
  } else {
    return value;
  }
}

template <class Type>
[[nodiscard]] constexpr const Type& value_in(const Type& value) {
  return value;
}
template <class ObjectType>
[[nodiscard]] constexpr typename ObjectType::type value_in(const ValueOf<ObjectType>& value) {
  return value.value();
}
template <class ObjectType>
[[nodiscard]] constexpr typename ObjectType::type value_in(const CheckedValue<ObjectType>& value) {
  return value.value();
}
template <class ObjectType>
[[nodiscard]] constexpr const typename ObjectType::type& value_in(const StringOf<ObjectType>& value) {
  return value.value();
}

template <class ObjectType>
struct CheckedParameter : Parameter<ObjectType> {};
template <class ObjectType>
requires rejects_values<ObjectType>
struct CheckedParameter<ObjectType> {
  using type = CheckedValue<ObjectType>;
};

}  // namespace value_for_detail

/// The type of a parameter for a value of an object: ValueOf, StringOf, a time or a DOMAIN.
template <DictionaryObject ObjectType>
using ParameterFor = typename value_for_detail::Parameter<ObjectType>::type;

/// The same where nothing checks the value at run time: a variable of an object that rejects values must be a
/// CheckedValue.
template <DictionaryObject ObjectType>
using CheckedParameterFor = typename value_for_detail::CheckedParameter<ObjectType>::type;

}  // namespace canopen
