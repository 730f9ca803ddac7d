/// Values for objects that are known at compile time: which types an object accepts, and its limits.
#pragma once

#include <concepts>
#include <cstdint>
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

/// Checks a value against the range of the object's type and its limits: value_too_high, value_too_low, or
/// invalid_value for a NaN written to a REAL with limits, and for a value between the limits that is not accepted.
template <NumberObject O, ValueFor<O> V>
[[nodiscard]] constexpr AbortCode check_value(V value) {
  using T = typename O::type;
  if constexpr (value_for_detail::Integer<T>) {
    if (std::cmp_greater(value, high_limit<O>())) return AbortCode::value_too_high;
    if (std::cmp_less(value, low_limit<O>())) return AbortCode::value_too_low;
    if (!accepts<O>(static_cast<T>(value))) return AbortCode::invalid_value;
  } else if constexpr (std::floating_point<T>) {
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

// Called by constants that an object does not accept. They are not constexpr, so that the compiler reports them with
// the name of the object.
template <class O>
void constant_is_above_the_high_limit() {}
template <class O>
void constant_is_below_the_low_limit() {}
template <class O>
void constant_is_not_an_accepted_value() {}

}  // namespace value_for_detail

/// A constant for an object. The compiler checks it against the type and the limits of the object: a constant outside
/// does not compile, and neither does a variable of another type.
template <NumberObject O>
class ConstantFor {
 public:
  using type = typename O::type;

  template <ValueFor<O> V>
  // NOLINTNEXTLINE(google-explicit-constructor): `set(od::x{}, 420)` converts the number
  consteval ConstantFor(V value) : value_{static_cast<type>(value)} {
    const AbortCode code = check_value<O>(value);
    if (code == AbortCode::value_too_high) value_for_detail::constant_is_above_the_high_limit<O>();
    if (code == AbortCode::value_too_low) value_for_detail::constant_is_below_the_low_limit<O>();
    if constexpr (requires { O::accepted; }) {
      if (code == AbortCode::invalid_value) value_for_detail::constant_is_not_an_accepted_value<O>();
    }
  }
  [[nodiscard]] constexpr type value() const { return value_; }

 private:
  type value_;
};

}  // namespace canopen
