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
  template <DictionaryObject O>
  requires(!can_be_refused<O>) void post(O, std::type_identity_t<ParameterFor<O>> value) {
    slot<O>().publish(value_for_detail::value_in(value));
  }
  template <DictionaryObject O>
  requires(!can_be_refused<O>) void post(std::type_identity_t<ParameterFor<O>> value) { post(O{}, value); }

  /// The same for an object with limits. value_too_high, value_too_low: outside the limits of the EDS; invalid_value: a
  /// REAL is NaN. The value posted before remains.
  template <LimitedObject O, FitsInto<typename O::type> V>
  [[nodiscard]] AbortCode post(O, V value) {
    const AbortCode code = check_limits<O>(value);
    if (code == ok) slot<O>().publish(value);
    return code;
  }
  template <LimitedObject O, FitsInto<typename O::type> V>
  [[nodiscard]] AbortCode post(V value) {
    return post(O{}, value);
  }
  /// A constant is not refused.
  template <LimitedObject O>
  void post(O, std::type_identity_t<ConstantFor<O>> value) {
    slot<O>().publish(value.value());
  }
  template <LimitedObject O>
  AbortCode post(std::type_identity_t<ConstantFor<O>> value) {
    slot<O>().publish(value.value());
    return ok;
  }

  /// A text of a length that is known at run time only. length_too_high: it is longer than the string of the object.
  template <StringObject O, TextFor<O> V>
  [[nodiscard]] AbortCode post(O, const V& text) {
    const auto string = O::type::from(text);
    if (string) slot<O>().publish(*string);
    return string.abort_code();
  }
  template <StringObject O, TextFor<O> V>
  [[nodiscard]] AbortCode post(const V& text) {
    return post(O{}, text);
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
  template <DictionaryObject O>
  struct Slot : SharedValue<typename O::type> {};
  struct Slots : Slot<Objects>... {};

  template <DictionaryObject O>
  [[nodiscard]] Slot<O>& slot() {
    static_assert((std::is_same_v<O, Objects> || ...), "this object is not in the list of the mailbox");
    return slots_;
  }
  template <DictionaryObject O>
  [[nodiscard]] const Slot<O>& slot() const {
    return slots_;
  }

  template <DictionaryObject O, class Node>
  void take_over_one(Node& node) {
    using Device = typename Node::DeviceType;
    if constexpr (is_in_dictionary<O, Device> && !is_of_another_device<O, Device>) {  // see node/handler_check.hpp
      if (const auto value = slot<O>().take()) static_cast<void>(node.template set<O>(*value));  // limits: see post
    }
  }

  Slots slots_;
};

/// A mailbox of a node, passed with its handlers.
template <class M>
struct ValuesFrom {
  M* mailbox;
};

/// Gives a node the values of a mailbox, which must outlive it. A node may have several mailboxes, and a mailbox has
/// one node.
template <DictionaryObject... Objects>
[[nodiscard]] constexpr ValuesFrom<Mailbox<Objects...>> values_from(Mailbox<Objects...>& mailbox) {
  return {&mailbox};
}

namespace mailbox_detail {

template <class Handler>
inline constexpr bool is_values_from = false;
template <class M>
inline constexpr bool is_values_from<ValuesFrom<M>> = true;

}  // namespace mailbox_detail

}  // namespace canopen
