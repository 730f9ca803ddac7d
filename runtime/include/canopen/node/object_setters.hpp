/// `set` of a node with its overloads: which values of an object compile, and whether the result must be used.
#pragma once

#include <concepts>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/value_check.hpp"
#include "canopen/od/device_object.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"
#include "canopen/od/value_for.hpp"

namespace canopen {

/// An object whose value is a number or a BOOLEAN with limits. Its constants are checked by the compiler, its other
/// values when they are set.
template <class Object>
concept LimitedObject = NumberObject<Object> && can_be_refused<Object> && !is_communication_index(Object::index);

/// A parameter of a service, which may not be changed at all times.
template <class Object>
concept ServiceParameter = can_be_refused<Object> && is_communication_index(Object::index);

/// Base of a class that sets values of objects: `set(od::pressure{}, 420)` or `set<od::pressure>(420)`. A value has the
/// type of its object or a narrower one, or is a constant, whose limits the compiler checks; anything else does not
/// compile. `Derived::assign<Object>(const Object::type&)` sets a value and returns an AbortCode; `Derived::DeviceType`
/// is the device.
template <class Derived>
class ObjectSetters {
 public:
  /// Every value of the type is accepted.
  template <DictionaryObject Object>
  requires(!can_be_refused<Object>) AbortCode set(Object, std::type_identity_t<ParameterFor<Object>> value) {
    return assign<Object>(value_for_detail::value_in(value));
  }
  template <DictionaryObject Object>
  requires(!can_be_refused<Object>) AbortCode set(std::type_identity_t<ParameterFor<Object>> value) {
    return assign<Object>(value_for_detail::value_in(value));
  }

  /// value_too_high, value_too_low, or invalid_value for NaN: outside the limits of the object.
  template <LimitedObject Object, FitsInto<typename Object::type> ValueType>
  requires(!ClosedObject<Object> || is_raw_number<ValueType>) [[nodiscard]] AbortCode set(Object, ValueType value) {
    return assign<Object>(value_for_detail::value_as<typename Object::type>(value));
  }
  template <LimitedObject Object, FitsInto<typename Object::type> ValueType>
  requires(!ClosedObject<Object> || is_raw_number<ValueType>) [[nodiscard]] AbortCode set(ValueType value) {
    return assign<Object>(value_for_detail::value_as<typename Object::type>(value));
  }
  /// A constant is not refused.
  template <LimitedObject Object>
  void set(Object, std::type_identity_t<CheckedValue<Object>> value) {
    static_cast<void>(assign<Object>(value.value()));
  }
  template <LimitedObject Object>
  AbortCode set(std::type_identity_t<CheckedValue<Object>> value) {
    return assign<Object>(value.value());
  }

  /// A closed enumeration: its enumerators are not refused, a variable may be.
  template <LimitedObject Object>
  requires ClosedObject<Object> AbortCode set(Object, typename Object::type value) { return assign<Object>(value); }
  template <LimitedObject Object>
  requires ClosedObject<Object> AbortCode set(typename Object::type value) { return assign<Object>(value); }

  /// A parameter of a service is refused if it may not be changed now.
  template <ServiceParameter Object>
  [[nodiscard]] AbortCode set(Object, std::type_identity_t<ValueOf<Object>> value) {
    return assign<Object>(value.value());
  }
  template <ServiceParameter Object>
  [[nodiscard]] AbortCode set(std::type_identity_t<ValueOf<Object>> value) {
    return assign<Object>(value.value());
  }

  /// A text of a length that is known at run time only. length_too_high: it is longer than the string of the object.
  template <StringObject Object, TextFor<Object> ValueType>
  [[nodiscard]] AbortCode set(Object, const ValueType& text) {
    return assign_text<Object>(text);
  }
  template <StringObject Object, TextFor<Object> ValueType>
  [[nodiscard]] AbortCode set(const ValueType& text) {
    return assign_text<Object>(text);
  }

  /// A constant as a template argument: `set<od::target_position, 4'000>()`.
  template <DictionaryObject Object, auto Value>
  requires(ValueFor<std::remove_cv_t<decltype(Value)>, Object>) AbortCode set() {
    static_assert(check_value<Object>(Value) == ok, "this value is outside the limits of the object");
    return assign<Object>(static_cast<typename Object::type>(Value));
  }
  /// A constant with a unit, or a raw number: `set<od::setpoint, 21.5_degC>()`.
  template <DictionaryObject Object, auto Value>
  requires(Meaningful<typename Object::type> && !ValueFor<std::remove_cv_t<decltype(Value)>, Object>) AbortCode set() {
    constexpr CheckedValue<Object> checked{Value};
    return assign<Object>(checked.value());
  }

 private:
  template <DictionaryObject Object>
  [[nodiscard]] AbortCode assign(const typename Object::type& value) {
    using Device = typename Derived::DeviceType;
    constexpr bool exists = is_in_dictionary<Object, Device>;
    constexpr bool is_foreign = exists && is_of_another_device<Object, Device>;
    constexpr bool is_domain = std::is_same_v<typename Object::type, Domain>;
    constexpr bool is_constant =
        exists && entry::place_of(Device::dictionary.find(Object::index, Object::sub_index)) != entry::Place::ram;
    constexpr bool is_array = lacks_sub_index<Object, Device>;
    static_assert(!is_array, "set: an ARRAY has many elements; give its sub-index: array<1>");
    static_assert(is_array || exists, "set: this device does not have the object");
    static_assert(!is_foreign, "set: this is an object of another device; this device has another one at its index");
    static_assert(!is_constant, "set: a constant of the EDS cannot be set");
    static_assert(!is_domain, "set: the memory of a DOMAIN is bound with bind()");
    if constexpr (exists && !is_foreign && !is_constant && !is_domain)
      return static_cast<Derived&>(*this).template assign<Object>(value);
    return ok;
  }
  template <StringObject Object>
  [[nodiscard]] AbortCode assign_text(const typename value_for_detail::TextOf<typename Object::type>::type& text) {
    if (text.size() > Object::type::capacity() / sizeof(*text.data())) return AbortCode::length_too_high;
    return assign<Object>(Object::type::truncated(text));
  }
};

}  // namespace canopen
