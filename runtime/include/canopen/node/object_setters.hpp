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
template <class O>
concept LimitedObject = NumberObject<O> && can_be_refused<O> && !is_communication_index(O::index);

/// A parameter of a service, which may not be changed at all times.
template <class O>
concept ServiceParameter = can_be_refused<O> && is_communication_index(O::index);

/// Base of a class that sets values of objects: `set(od::pressure{}, 420)` or `set<od::pressure>(420)`. A value has the
/// type of its object or a narrower one, or is a constant, whose limits the compiler checks; anything else does not
/// compile. `Derived::assign<O>(const O::type&)` sets a value and returns an AbortCode; `Derived::DeviceType` is the
/// device.
template <class Derived>
class ObjectSetters {
 public:
  /// Every value of the type is accepted.
  template <DictionaryObject O>
  requires(!can_be_refused<O>) AbortCode set(O, std::type_identity_t<ParameterFor<O>> value) {
    return assign<O>(value_for_detail::value_in(value));
  }
  template <DictionaryObject O>
  requires(!can_be_refused<O>) AbortCode set(std::type_identity_t<ParameterFor<O>> value) {
    return assign<O>(value_for_detail::value_in(value));
  }

  /// value_too_high, value_too_low, or invalid_value for NaN: outside the limits of the object.
  template <LimitedObject O, FitsInto<typename O::type> V>
  [[nodiscard]] AbortCode set(O, V value) {
    return assign<O>(value);
  }
  template <LimitedObject O, FitsInto<typename O::type> V>
  [[nodiscard]] AbortCode set(V value) {
    return assign<O>(value);
  }
  /// A constant is not refused.
  template <LimitedObject O>
  void set(O, std::type_identity_t<ConstantFor<O>> value) {
    static_cast<void>(assign<O>(value.value()));
  }
  template <LimitedObject O>
  AbortCode set(std::type_identity_t<ConstantFor<O>> value) {
    return assign<O>(value.value());
  }

  /// A parameter of a service is refused if it may not be changed now.
  template <ServiceParameter O>
  [[nodiscard]] AbortCode set(O, std::type_identity_t<ValueOf<O>> value) {
    return assign<O>(value.value());
  }
  template <ServiceParameter O>
  [[nodiscard]] AbortCode set(std::type_identity_t<ValueOf<O>> value) {
    return assign<O>(value.value());
  }

  /// A text of a length that is known at run time only. length_too_high: it is longer than the string of the object.
  template <StringObject O, TextFor<O> V>
  [[nodiscard]] AbortCode set(O, const V& text) {
    return assign_text<O>(text);
  }
  template <StringObject O, TextFor<O> V>
  [[nodiscard]] AbortCode set(const V& text) {
    return assign_text<O>(text);
  }

  /// A constant as a template argument: `set<od::target_position, 4'000>()`.
  template <DictionaryObject O, auto Value>
  requires(ValueFor<decltype(Value), O>) AbortCode set() {
    static_assert(check_value<O>(Value) == ok, "this value is outside the limits of the object");
    return assign<O>(static_cast<typename O::type>(Value));
  }

 private:
  template <DictionaryObject O>
  [[nodiscard]] AbortCode assign(const typename O::type& value) {
    using Device = typename Derived::DeviceType;
    constexpr bool exists = is_in_dictionary<O, Device>;
    constexpr bool is_foreign = exists && is_of_another_device<O, Device>;
    constexpr bool is_domain = std::is_same_v<typename O::type, Domain>;
    constexpr bool is_constant =
        exists && entry::place_of(Device::dictionary.find(O::index, O::sub_index)) != entry::Place::ram;
    static_assert(exists, "set: this device does not have the object");
    static_assert(!is_foreign, "set: this is an object of another device; this device has another one at its index");
    static_assert(!is_constant, "set: a constant of the EDS cannot be set");
    static_assert(!is_domain, "set: the memory of a DOMAIN is bound with bind()");
    if constexpr (exists && !is_foreign && !is_constant && !is_domain)
      return static_cast<Derived&>(*this).template assign<O>(value);
    return ok;
  }
  template <StringObject O>
  [[nodiscard]] AbortCode assign_text(const typename value_for_detail::TextOf<typename O::type>::type& text) {
    if (text.size() > O::type::capacity() / sizeof(*text.data())) return AbortCode::length_too_high;
    return assign<O>(O::type::truncated(text));
  }
};

}  // namespace canopen
