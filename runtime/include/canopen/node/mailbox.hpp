/// Values of objects from an interrupt or another task: the node takes them over in its own context.
///
///     canopen::Mailbox<od::pressure, od::temperature> measured;
///     auto sensor = canopen::make_node<Device>(bus, NodeId{5}, canopen::values_from(measured));
///
///     extern "C" void ADC1_IRQHandler() { measured.post(od::temperature{}, converted(ADC1->DR)); }
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/shared_value.hpp"
#include "canopen/node/object_setters.hpp"
#include "canopen/node/value_check.hpp"
#include "canopen/node/values_from.hpp"
#include "canopen/od/device_object.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"
#include "canopen/od/value_for.hpp"

namespace canopen {

/// The latest posted value of each of these objects, of 2000h..FFFFh. For each object one context calls `post`, which
/// does not wait; another object may have another context. The next `on_time` of the node sets the values, as `set`
/// does: until then `next_deadline` of the node is due. A loop that sleeps must be woken after `post`, by the interrupt
/// itself or by a notification; docs/contexts.md shows how.
template <DictionaryObject... Objects>
class Mailbox {
  static_assert((!is_communication_index(Objects::index) && ...),
                "a parameter in 1000h..1FFFh is set in the context of the node, which checks it");
  static_assert((!std::is_same_v<typename Objects::type, Domain> && ...),
                "the memory of a DOMAIN is bound with bind()");

 public:
  /// Replaces the posted value. A value has the type of its object or a narrower one, or is a constant, whose limits
  /// the compiler checks; anything else does not compile.
  template <DictionaryObject Object>
  requires(!can_be_refused<Object>) void post(Object, std::type_identity_t<ParameterFor<Object>> value) {
    slot<Object>().publish(value_for_detail::value_in(value));
  }
  template <DictionaryObject Object>
  requires(!can_be_refused<Object>) void post(std::type_identity_t<ParameterFor<Object>> value) {
    post(Object{}, value);
  }

  /// The same for an object with limits. value_too_high, value_too_low: outside the limits of the EDS; invalid_value: a
  /// REAL is NaN. The value posted before remains.
  template <LimitedObject Object, FitsInto<typename Object::type> Value>
  [[nodiscard]] AbortCode post(Object, Value given) {
    const auto value = value_for_detail::value_as<typename Object::type>(given);
    const AbortCode code = check_limits<Object>(value);
    if (code == ok) slot<Object>().publish(value);
    return code;
  }
  template <LimitedObject Object, FitsInto<typename Object::type> Value>
  [[nodiscard]] AbortCode post(Value value) {
    return post(Object{}, value);
  }
  /// A constant is not refused.
  template <LimitedObject Object>
  void post(Object, std::type_identity_t<CheckedValue<Object>> value) {
    slot<Object>().publish(value.value());
  }
  template <LimitedObject Object>
  AbortCode post(std::type_identity_t<CheckedValue<Object>> value) {
    slot<Object>().publish(value.value());
    return ok;
  }

  /// A text of a length that is known at run time only. length_too_high: it is longer than the string of the object.
  template <StringObject Object, TextFor<Object> Value>
  [[nodiscard]] AbortCode post(Object, const Value& text) {
    const auto string = Object::type::from(text);
    if (string) slot<Object>().publish(*string);
    return string.abort_code();
  }
  template <StringObject Object, TextFor<Object> Value>
  [[nodiscard]] AbortCode post(const Value& text) {
    return post(Object{}, text);
  }

  // ---- the context of the node ----

  /// Whether a value waits for `on_time` of the node. A loop checks it before it sleeps.
  [[nodiscard]] bool pending() const { return (slot<Objects>().is_new() || ...); }

  /// Sets the objects that have been posted. Called by the node.
  template <class Node>
  void take_over(Node& node) {
    (take_over_one<Objects>(node), ...);
  }

  /// Whether each object is in the dictionary of a device.
  template <class Device>
  static constexpr bool fits = (Device::dictionary.has(Objects::index, Objects::sub_index) && ...);

 private:
  template <DictionaryObject Object>
  struct Slot : SharedValue<typename Object::type> {};
  struct Slots : Slot<Objects>... {};

  template <DictionaryObject Object>
  [[nodiscard]] Slot<Object>& slot() {
    static_assert((std::is_same_v<Object, Objects> || ...), "this object is not in the list of the mailbox");
    return slots_;
  }
  template <DictionaryObject Object>
  [[nodiscard]] const Slot<Object>& slot() const {
    return slots_;
  }

  template <DictionaryObject Object, class Node>
  void take_over_one(Node& node) {
    using Device = typename Node::DeviceType;
    if constexpr (is_in_dictionary<Object, Device> &&
                  !is_of_another_device<Object, Device>) {  // see node/handler_check.hpp
      if (const auto value = slot<Object>().take())
        static_cast<void>(node.template set<Object>(*value));  // limits: see post
    }
  }

  Slots slots_;
};

/// Gives a node the values of a mailbox, which must outlive it. A node may have several mailboxes, and a mailbox has
/// one node.
template <DictionaryObject... Objects>
[[nodiscard]] constexpr ValuesFrom<Mailbox<Objects...>> values_from(Mailbox<Objects...>& mailbox) {
  return {&mailbox};
}

}  // namespace canopen
