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
#include "canopen/od/accepted_values.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

/// A string object: its value type has a capacity.
template <class O>
concept StringObject = DictionaryObject<O> && requires {
  O::type::capacity();
};

template <class O>
concept DomainObject = DictionaryObject<O> && std::same_as<typename O::type, Domain>;

/// An object whose value is a number, a BOOLEAN or a time.
template <class O>
concept NumberObject = DictionaryObject<O> && O::bits >
0;

namespace value_for_detail {

template <class V>
concept Integer = std::integral<V> && !std::same_as<V, bool> && !std::same_as<V, char>;

template <class V>
concept Number = Integer<V> || std::floating_point<V>;

}  // namespace value_for_detail

/// A value that can be written to an object: of the same type, an integer to an integer, any number to a REAL.
template <class V, class O>
concept ValueFor = NumberObject<O> &&(std::same_as<V, typename O::type> ||
                                      (value_for_detail::Integer<V> && value_for_detail::Integer<typename O::type>) ||
                                      (value_for_detail::Number<V> && std::floating_point<typename O::type>));

/// A type whose values all fit into another one: the same type, or an integer or REAL that is not wider.
template <class V, class T>
concept FitsInto = std::same_as<V, T> ||
                   (value_for_detail::Integer<V>&& value_for_detail::Integer<T>&& std::cmp_greater_equal(
                        std::numeric_limits<V>::min(), std::numeric_limits<T>::min()) &&
                    std::cmp_less_equal(std::numeric_limits<V>::max(), std::numeric_limits<T>::max())) ||
                   (std::same_as<V, float> && std::same_as<T, double>);

/// Checks a value against the range of the object's type and its limits: value_too_high, value_too_low, or
/// invalid_value for a NaN written to a REAL with limits, and for a value between the limits that is not accepted. A
/// finite number beyond a REAL32 is too high or too low.
template <NumberObject O, ValueFor<O> V>
[[nodiscard]] constexpr AbortCode check_value(V value) {
  using T = typename O::type;
  if constexpr (value_for_detail::Integer<T>) {
    if (std::cmp_greater(value, high_limit<O>())) return AbortCode::value_too_high;
    if (std::cmp_less(value, low_limit<O>())) return AbortCode::value_too_low;
    if (!accepts<O>(static_cast<T>(value))) return AbortCode::invalid_value;
  } else if constexpr (std::floating_point<T>) {
    if constexpr (sizeof(V) > sizeof(T) && std::floating_point<V>) {
      constexpr V infinity = std::numeric_limits<V>::infinity();
      if (value > std::numeric_limits<T>::max() && value != infinity) return AbortCode::value_too_high;
      if (value < std::numeric_limits<T>::lowest() && value != -infinity) return AbortCode::value_too_low;
    }
    [[maybe_unused]] const auto real = static_cast<T>(value);
    if constexpr (requires { O::high_limit; }) {
      if (real != real) return AbortCode::invalid_value;
      if (real > O::high_limit) return AbortCode::value_too_high;
    }
    if constexpr (requires { O::low_limit; }) {
      if (real != real) return AbortCode::invalid_value;
      if (real < O::low_limit) return AbortCode::value_too_low;
    }
  }
  return ok;
}

namespace value_for_detail {

// A constant that an object does not accept reads the element after the only one: the compiler's message has the name
// of the array and that of the object.
template <class O>
inline constexpr bool constant_is_above_the_high_limit[1] = {};
template <class O>
inline constexpr bool constant_is_below_the_low_limit[1] = {};
template <class O>
inline constexpr bool constant_is_not_an_accepted_value[1] = {};

/// The characters of a literal for a string.
template <class T>
struct CharacterOf {};
template <std::size_t Capacity>
struct CharacterOf<VisibleString<Capacity>> {
  using type = char;
};
template <std::size_t Capacity>
struct CharacterOf<UnicodeString<Capacity>> {
  using type = char16_t;
};

template <class Character, class T>
concept CharacterFor = std::same_as<Character, typename CharacterOf<T>::type>;

/// What a string is made of at run time.
template <class T>
struct TextOf {
  using type = std::basic_string_view<typename CharacterOf<T>::type>;
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

template <class V>
concept Variable = !std::is_const_v<V>;

}  // namespace value_for_detail

/// A constant for an object. The compiler checks it against the type and the limits of the object: a constant outside
/// does not compile, and neither does a variable of another type.
template <NumberObject O>
class ConstantFor {
 public:
  using type = typename O::type;

  template <ValueFor<O> V>
  // NOLINTNEXTLINE(google-explicit-constructor): `set(od::x{}, 420)` converts the number
  consteval ConstantFor(const V& constant) : value_{static_cast<type>(constant)} {
    using namespace value_for_detail;
    const AbortCode code = check_value<O>(constant);
    if (constant_is_above_the_high_limit<O>[element_of(code, AbortCode::value_too_high)]) value_ = {};
    if (constant_is_below_the_low_limit<O>[element_of(code, AbortCode::value_too_low)]) value_ = {};
    if (constant_is_not_an_accepted_value<O>[element_of(code, AbortCode::invalid_value)]) value_ = {};
  }
  /// A variable of another type.
  template <value_for_detail::Variable V>
  requires(ValueFor<V, O>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ConstantFor(V&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<O, V>,
                  "the type of this value is wider than that of the object, or has another sign: check its range, then "
                  "static_cast it");
  }
  /// A value that is not a number for the object.
  template <class V>
  requires(!ValueFor<V, O>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ConstantFor(const V&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<O, V>, "this value is not of the type of the object");
  }
  [[nodiscard]] constexpr type value() const { return value_; }

 private:
  type value_;
};

/// A value for an object, as the parameter of a function: a value of its type or of a narrower one, or a constant,
/// whose limits the compiler checks. Nothing else compiles: no number is truncated, and none changes its sign.
template <NumberObject O>
class ValueOf {
 public:
  using type = typename O::type;

  template <FitsInto<type> V>
  constexpr ValueOf(V value) : value_{value} {}  // NOLINT(google-explicit-constructor): `pack(speed)` converts a number
  /// A constant of another type, such as `int`.
  template <ValueFor<O> V>
  requires(!FitsInto<V, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      consteval ValueOf(const V& constant)
      : value_{static_cast<type>(constant)} {
    using namespace value_for_detail;
    const AbortCode code = check_value<O>(constant);
    if (constant_is_above_the_high_limit<O>[element_of(code, AbortCode::value_too_high)]) value_ = {};
    if (constant_is_below_the_low_limit<O>[element_of(code, AbortCode::value_too_low)]) value_ = {};
    if (constant_is_not_an_accepted_value<O>[element_of(code, AbortCode::invalid_value)]) value_ = {};
  }
  /// A variable of another type.
  template <value_for_detail::Variable V>
  requires(ValueFor<V, O> && !FitsInto<V, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ValueOf(V&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<O, V>,
                  "the type of this value is wider than that of the object, or has another sign: check its range, then "
                  "static_cast it");
  }
  /// A value that is not a number for the object.
  template <class V>
  requires(!ValueFor<V, O> && !FitsInto<V, type>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr ValueOf(const V&)
      : value_{} {
    static_assert(value_for_detail::has_the_type_of<O, V>, "this value is not of the type of the object");
  }

  [[nodiscard]] constexpr type value() const { return value_; }

 private:
  type value_;
};

/// A string for an object, as the parameter of a function: a value of its type, or a literal, whose length the compiler
/// checks.
template <StringObject O>
class StringOf {
 public:
  using type = typename O::type;

  constexpr StringOf(const StringOf&) = default;
  constexpr StringOf(const type& value) : value_{value} {}  // NOLINT(google-explicit-constructor): a string is one
  template <std::size_t Size, value_for_detail::CharacterFor<type> Character>
  consteval StringOf(const Character (&literal)[Size]) {  // NOLINT(google-explicit-constructor): a text is one
    static_assert(value_for_detail::has_room_for<O, Size>, "this text is longer than the string of the object");
    if constexpr (value_for_detail::has_room_for<O, Size>) value_ = type{literal};
  }
  consteval StringOf(std::initializer_list<std::uint8_t> octets)  // NOLINT(google-explicit-constructor)
      requires std::constructible_from<type, std::initializer_list<std::uint8_t>> : value_{octets} {}
  /// A value that is not a string of the object.
  template <class V>
  requires(!std::is_array_v<V>)
      // NOLINTNEXTLINE(google-explicit-constructor)
      constexpr StringOf(const V&) {
    static_assert(value_for_detail::has_the_type_of<O, V>, "this value is not of the type of the object");
  }

  [[nodiscard]] constexpr const type& value() const { return value_; }

 private:
  type value_{};
};

/// A text whose length is known at run time only.
template <class V, class O>
concept TextFor = StringObject<O> && !std::is_array_v<V> &&
                  std::convertible_to<const V&, typename value_for_detail::TextOf<typename O::type>::type>;

namespace value_for_detail {

template <class O>
struct Parameter {
  using type = const typename O::type&;
};
template <class O>
requires(NumberObject<O>&& std::is_arithmetic_v<typename O::type>) struct Parameter<O> {
  using type = ValueOf<O>;
};
template <StringObject O>
struct Parameter<O> {
  using type = StringOf<O>;
};

template <class T>
[[nodiscard]] constexpr const T& value_in(const T& value) {
  return value;
}
template <class O>
[[nodiscard]] constexpr typename O::type value_in(const ValueOf<O>& value) {
  return value.value();
}
template <class O>
[[nodiscard]] constexpr const typename O::type& value_in(const StringOf<O>& value) {
  return value.value();
}

}  // namespace value_for_detail

/// The type of a parameter for a value of an object: ValueOf, StringOf, a time or a DOMAIN.
template <DictionaryObject O>
using ParameterFor = typename value_for_detail::Parameter<O>::type;

}  // namespace canopen
